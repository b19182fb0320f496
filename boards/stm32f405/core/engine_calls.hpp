// Intercepts internal functions of Unicorn (the engine), because the public interface of Unicorn has no hooks for
// internal functions.
//
// Unicorn 2.0.1 calls its internal functions through the procedure linkage table. A function of the same name in this
// program replaces the engine's function and calls the original function. The replaced functions translate loads and
// stores, fill the address cache, perform uncached accesses, and report whether a priority is negative. The
// replacements check alignment and access rights. Allowed accesses remain as fast as without checks. A refused access
// raises a fault with the correct program counter and if-then state.
#pragma once

#include <cstdint>

namespace inkwell::virtual_board {

class EngineCalls {
 public:
  /// The values match the access types of the engine.
  enum class Access : int { load, store, fetch };
  /// The values match the access-right bits of the engine.
  enum Rights : int { may_read = 1, may_write = 2, may_execute = 4 };

  /// The execution role determines the access rights. The engine has one address cache per role.
  struct Role {
    bool privileged;
    bool above_faults;  ///< negative priority: HardFault, NMI, or FAULTMASK set
  };

  virtual ~EngineCalls() = default;
  /// Returns true if the access must fault. The engine calls this function if its address cache has no entry for the
  /// access.
  virtual bool refuses(std::uint32_t address, unsigned bytes, Access access, Role role) = 0;
  /// Returns the access rights of the page, or a negative number if the rights differ within the page.
  virtual int rights_in_page(std::uint32_t page, std::uint32_t bytes, Role role) = 0;
  /// Returns true if the current role may fetch an instruction half-word at this address.
  virtual bool may_fetch(std::uint32_t address) const = 0;
  /// Returns true if the running code has Role::above_faults. The engine calls this function after each possible change
  /// of the role.
  virtual bool runs_above_faults() const = 0;
  /// Returns true if the page contains no instructions. Stores to the page then need no check for translated code.
  virtual bool takes_plain_stores(std::uint32_t page) const = 0;
  /// Returns true if all accesses to this address must be aligned to their size.
  virtual bool is_device(std::uint32_t address, Role role) const = 0;
  /// Reports a misaligned access. The access then faults.
  virtual void misaligned(std::uint32_t address) = 0;
  /// Returns true if this load or store instruction requires an aligned address. The engine calls this function when it
  /// translates the instruction.
  virtual bool must_be_aligned(std::uint16_t first, std::uint16_t second) const = 0;
  /// The engine calls this function when it translates the instruction at `address`.
  virtual void translates(std::uint32_t address) = 0;

  /// While a Use object exists, the engine of this thread calls the functions of the given EngineCalls object.
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
  /// Stores the processor pointer of the engine.
  void remember_processor(void* processor) { processor_ = processor; }
  void* remembered_processor() const { return processor_; }

 private:
  void* processor_ = nullptr;
};

}  // namespace inkwell::virtual_board
