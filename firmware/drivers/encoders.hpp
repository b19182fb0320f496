// TIM5, TIM3 and TIM4 count the three quadrature encoders in encoder mode (RM0090, "Encoder interface mode").
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "firmware/drivers/claims.hpp"
#include "firmware/registers/peripherals.hpp"

namespace inkwell::drivers {

class Encoders {
 public:
  static constexpr std::array claims{
      peripheral<registers::TIM5>(), pin(board::facts.encoders[0].a), pin(board::facts.encoders[0].b),
      peripheral<registers::TIM3>(), pin(board::facts.encoders[1].a), pin(board::facts.encoders[1].b),
      peripheral<registers::TIM4>(), pin(board::facts.encoders[2].a), pin(board::facts.encoders[2].b)};

  /// Starts to count from 0. Every edge of both channels is counted, so each encoder line results in four counts.
  void start();

  /// Timer counts modulo 65536. TIM5 has 32 bits, but read() returns 16 bits for all timers.
  std::array<std::uint16_t, 3> read() const;

  /// Returns true if no encoder drives wire A or B of `encoder` (0..2), so that a pull resistor can change the level.
  /// The check takes 20 us.
  bool wire_a_floats(std::size_t encoder) const;
  bool wire_b_floats(std::size_t encoder) const;
};

}  // namespace inkwell::drivers
