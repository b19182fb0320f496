// Interception of functions inside the engine (Unicorn), because its public interface has no hook for them.
//
// Unicorn 2.0.1 calls these functions through the procedure linkage table. A definition in the program replaces the
// engine's function and calls the original. The functions translate loads and stores, fill the address cache, serve
// uncached accesses, and report whether a priority is negative. These functions check alignment and rights without cost
// for allowed accesses. A refused access faults with the program counter and if-then state of its instruction.
#pragma once

#include <cstdint>

namespace inkwell::virtual_board {

class EngineCalls {
 public:
  /// Values are those of the engine.
  enum class Access : int { load, store, fetch };
  /// Values are the bits of the engine.
  enum Rights : int { may_read = 1, may_write = 2, may_execute = 4 };

  /// Execution role, which decides about access rights. The engine has one address cache per role.
  struct Role {
    bool privileged;
    bool above_faults;  ///< negative priority: HardFault, NMI, or FAULTMASK set
  };

  virtual ~EngineCalls() = default;
  /// Returns true if the access must fault. Called when the engine's address cache has no entry for the access.
  virtual bool refuses(std::uint32_t address, unsigned bytes, Access access, Role role) = 0;
  /// Rights that are valid in the whole page, or a negative number if they depend on the address.
  virtual int rights_in_page(std::uint32_t page, std::uint32_t bytes, Role role) = 0;
  /// True if the current role may fetch a half-word of an instruction at this address.
  virtual bool may_fetch(std::uint32_t address) const = 0;
  /// Role::above_faults of the current execution. The engine calls this function after possible changes of the role.
  virtual bool runs_above_faults() const = 0;
  /// True if the page contains no instructions, so that stores need no check for translated code.
  virtual bool takes_plain_stores(std::uint32_t page) const = 0;
  /// True if all accesses to this address must be aligned to their size.
  virtual bool is_device(std::uint32_t address, Role role) const = 0;
  /// Reports a misaligned access, which then faults.
  virtual void misaligned(std::uint32_t address) = 0;
  /// True if this load or store must be aligned to its size. Called when the instruction is translated.
  virtual bool must_be_aligned(std::uint16_t first, std::uint16_t second) const = 0;
  /// Reports the translation of the instruction at `address`, also after a possible change.
  virtual void translates(std::uint32_t address) = 0;

  /// While this object exists, the engine on this thread calls this EngineCalls object.
  class Use {
   public:
    explicit Use(EngineCalls& calls);
    ~Use();
    Use(const Use&) = delete;
    Use& operator=(const Use&) = delete;

   private:
    EngineCalls* before_;
  };
  /// Removes one page or all pages from the engine's address cache.
  void forget_page(std::uint32_t address);
  void forget_pages();
  /// Stores the engine's pointer to its processor.
  void remember_processor(void* processor) { processor_ = processor; }
  void* remembered_processor() const { return processor_; }

 private:
  void* processor_ = nullptr;
};

}  // namespace inkwell::virtual_board
