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

  /// Counts every edge of both channels, four per line, from 0.
  void start();

  /// Timer counts, which wrap at 16 bits. TIM5 has 32 bits, but the interface is the same for all three.
  std::array<std::uint16_t, 3> read() const;

  /// Whether wire A or B of `encoder`, 0..2, follows the internal pulls of its pin, so that no encoder drives it. Takes
  /// 20 us.
  bool wire_a_floats(std::size_t encoder) const;
  bool wire_b_floats(std::size_t encoder) const;
};

}  // namespace inkwell::drivers
