// The chip's own supply of 3.3 V, by its voltage detector (RM0090, "Programmable voltage detector").
#pragma once

#include <array>

#include <drivers/claims.hpp>
#include <drivers/interrupts.hpp>
#include <placement/interrupt.hpp>
#include <registers/peripherals.hpp>

namespace inkwell::drivers {

class LogicSupply {
 public:
  static constexpr std::array claims{peripheral<registers::EXTI>(), interrupt(Interrupt::voltage_detector)};

  /// From then on its interrupt comes when the supply falls too low. After start_clocks(), which gives the detector its
  /// clock.
  static void start() {
    using registers::PWR;
    constexpr std::uint32_t falls_at_2_92_V = 0b110;  // data sheet, V_PVD; and rises at 3.03 V
    PWR::CR::modify(PWR::CR::PLS(falls_at_2_92_V), PWR::CR::PVDE(1));
    Lines::RTSR::write(detector);  // its output is high while the supply is low
    Lines::IMR::write(detector);
    acknowledge();  // an edge that only switching it on has made; a supply that is low already, is_low() tells
    InterruptLine<LogicSupply, Interrupt::voltage_detector>::enable();
  }

  /// It has fallen below 2.9 V: a tenth of a volt before the brown-out reset, and the sensors' references fall with it.
  static bool is_low() { return registers::PWR::CSR::PVDO::is_set(); }

  /// Of the interrupt; at its beginning, so that the processor has seen it at the end.
  INKWELL_INTERRUPT static void acknowledge() { Lines::PR::write(detector); }

 private:
  using Lines = RegistersOf<LogicSupply, registers::EXTI>;
  static constexpr std::uint32_t detector = 1u << 16;  // RM0090, "External interrupt/event line mapping"
};

}  // namespace inkwell::drivers
