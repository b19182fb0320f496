// The three quadrature encoders, counted by TIM5, TIM3 and TIM4 in encoder mode (RM0090, "Encoder interface mode").
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include <drivers/claims.hpp>
#include <registers/peripherals.hpp>

namespace inkwell::drivers {

class Encoders {
 public:
  static constexpr std::array claims{
      peripheral<registers::TIM5>(), pin(board::facts.encoders[0].a), pin(board::facts.encoders[0].b),
      peripheral<registers::TIM3>(), pin(board::facts.encoders[1].a), pin(board::facts.encoders[1].b),
      peripheral<registers::TIM4>(), pin(board::facts.encoders[2].a), pin(board::facts.encoders[2].b)};

  /// Counts every edge of both channels, four a line, from 0.
  void start();

  /// The timers' counts, which wrap at 16 bits (TIM5 could do more; all three are alike on purpose).
  std::array<std::uint16_t, 3> read() const;

  /// Whether a wire of `encoder`, 0..2, does as the pin's own pulls do, so that no encoder drives it: A, or B. Takes
  /// 20 us.
  bool wire_a_floats(std::size_t encoder) const;
  bool wire_b_floats(std::size_t encoder) const;
};

}  // namespace inkwell::drivers
