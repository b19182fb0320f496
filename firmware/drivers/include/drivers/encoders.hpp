// The three quadrature encoders, counted by TIM5, TIM3 and TIM4 in encoder mode (RM0090, "Encoder interface mode").
#pragma once

#include <array>
#include <cstdint>

namespace inkwell::drivers {

class Encoders {
 public:
  /// Counts every edge of both channels, four a line, from 0.
  void start();

  /// The timers' counts, which wrap at 16 bits (TIM5 could do more; all three are alike on purpose).
  std::array<std::uint16_t, 3> read() const;
};

}  // namespace inkwell::drivers
