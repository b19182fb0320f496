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

  /// After start_clocks(), which gives the detector its clock.
  static void start() {
    using registers::PWR;
    constexpr std::uint32_t falls_at_2_92_V = 0b110;  // data sheet, V_PVD; and rises at 3.03 V
    PWR::CR::modify(PWR::CR::PLS(falls_at_2_92_V), PWR::CR::PVDE(1));
  }

  /// From now on its interrupt comes when the supply falls too low.
  static void arm() {
    Lines::RTSR::write(detector);  // its output is high while the supply is low
    Lines::IMR::write(detector);
    InterruptLine<LogicSupply, Interrupt::voltage_detector>::enable();
  }

  /// It is below 2.9 V: a tenth of a volt before the brown-out reset, and the sensors' references fall with it.
  static bool is_low() { return registers::PWR::CSR::PVDO::is_set(); }

  /// In the interrupt. False if it is not low any more, as after an edge of a detector that was just switched on.
  INKWELL_INTERRUPT static bool has_fallen() {
    Lines::PR::write(detector);
    return is_low();
  }

 private:
  using Lines = RegistersOf<LogicSupply, registers::EXTI>;
  static constexpr std::uint32_t detector = 1u << 16;  // RM0090, "External interrupt/event line mapping"
};

}  // namespace inkwell::drivers
