// Start of a peripheral clock.
#pragma once

#include <cstdint>

namespace inkwell::virtual_board {

/// A peripheral clock starts some cycles after its enable bit is set.
class StartingClock {
 public:
  /// `mask` selects the bits of the enable register that were set. `runs_at` is the core cycle at which the clocks run.
  void start(const std::uint32_t* enable_register, std::uint32_t mask, std::uint64_t runs_at) {
    register_ = enable_register;
    mask_ = mask;
    runs_at_ = runs_at;
  }
  /// Returns true if the clock of a peripheral is enabled but has not started yet.
  bool includes(const std::uint32_t* enable_register, std::uint32_t mask, std::uint64_t cycle) const {
    return cycle < runs_at_ && enable_register == register_ && (mask_ & mask) != 0;
  }

 private:
  std::uint64_t runs_at_ = 0;
  const std::uint32_t* register_ = nullptr;
  std::uint32_t mask_ = 0;
};

}  // namespace inkwell::virtual_board
