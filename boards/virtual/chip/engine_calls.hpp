// Where the engine's own functions pass through us, because its interface has no place for it.
//
// Unicorn 2.0.1 reaches these of its functions through the procedure linkage table, so a definition in the program
// takes their place and hands on to the engine's: what translates a load or a store, what fills the address cache,
// what serves an access that the cache does not, and what says whether a priority is negative.
// That is how alignment and rights are checked at no cost to an access that is allowed, and how the fault of one that
// is not has the instruction's own program counter and if-then state.
#pragma once

#include <cstdint>

namespace inkwell::virtual_board {

class EngineCalls {
 public:
  /// As the engine numbers them.
  enum class Access : int { load, store, fetch };
  /// As the engine's bits.
  enum Rights : int { may_read = 1, may_write = 2, may_execute = 4 };

  /// As what instructions run: what they may do depends on it. The engine's address cache is kept apart for each.
  struct Role {
    bool privileged;
    bool above_faults;  ///< with a negative priority: in HardFault or NMI, or with FAULTMASK set
  };

  virtual ~EngineCalls() = default;
  /// True lets the access fault. Asked when the engine's address cache does not know that it may pass.
  virtual bool refuses(std::uint32_t address, unsigned bytes, Access access, Role role) = 0;
  /// What `refuses` lets pass anywhere in the page, or a negative number if that depends on the place in it.
  virtual int rights_in_page(std::uint32_t page, std::uint32_t bytes, Role role) = 0;
  /// `refuses` would let a half-word of an instruction at this address pass, as what runs now.
  virtual bool may_fetch(std::uint32_t address) const = 0;
  /// Role::above_faults of what runs now. Asked after what may have changed it.
  virtual bool runs_above_faults() const = 0;
  /// Stores to the page cannot hit instructions.
  virtual bool takes_plain_stores(std::uint32_t page) const = 0;
  /// Accesses to this address must be aligned to their size, whatever the instruction.
  virtual bool is_device(std::uint32_t address, Role role) const = 0;
  /// An access that must be aligned is not; it faults.
  virtual void misaligned(std::uint32_t address) = 0;
  /// Asked when a load or a store is translated: it must be aligned to its size.
  virtual bool must_be_aligned(std::uint16_t first, std::uint16_t second) const = 0;
  /// The instruction at `address` is translated, for the first time or because it may have changed.
  virtual void translates(std::uint32_t address) = 0;

  /// While it lives, the engine that runs on this thread asks these.
  class Use {
   public:
    explicit Use(EngineCalls& calls);
    ~Use();
    Use(const Use&) = delete;
    Use& operator=(const Use&) = delete;

   private:
    EngineCalls* before_;
  };
  /// Of one page, of all pages.
  void forget_page(std::uint32_t address);
  void forget_pages();
  /// The engine tells which processor, in its own terms, it runs.
  void remember_processor(void* processor) { processor_ = processor; }
  void* remembered_processor() const { return processor_; }

 private:
  void* processor_ = nullptr;
};

}  // namespace inkwell::virtual_board
