// The stacked program status register xPSR combines APSR, EPSR and IPSR (ARMv7-M, B1.4.2).
#pragma once

#include "boards/stm32f405/core/register_map.hpp"

namespace inkwell::virtual_board {

struct ProgramStatus {
  Field exception{"exception", 0, 9};  ///< number of the running exception
  Field padded{"padded", 9};           ///< only on the stack: an alignment word precedes the frame
  Field if_then_high{"IT[7:2]", 10, 6}, if_then_low{"IT[1:0]", 25, 2};
  Field greater_or_equal{"GE", 16, 4}, thumb{"T", 24}, saturated{"Q", 27}, conditions{"NZCV", 28, 4};

  constexpr std::uint32_t if_then() const { return if_then_high.mask() | if_then_low.mask(); }
  /// ITSTATE.
  constexpr std::uint32_t if_then_state(std::uint32_t word) const {
    return if_then_high.of(word) << 2 | if_then_low.of(word);
  }
  /// All flags of the APSR.
  constexpr std::uint32_t flags() const { return greater_or_equal.mask() | saturated.mask() | conditions.mask(); }
};
inline constexpr ProgramStatus xpsr;
static_assert(xpsr.flags() == 0xF80F'0000 && xpsr.if_then() == 0x0600'FC00);

}  // namespace inkwell::virtual_board
