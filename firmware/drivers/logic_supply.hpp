// Monitors the 3.3 V CPU supply with the chip's voltage detector (RM0090, "Programmable voltage detector").
#pragma once

#include <array>

#include "firmware/drivers/claims.hpp"
#include "firmware/drivers/interrupts.hpp"
#include "firmware/placement/interrupt.hpp"
#include "firmware/registers/peripherals.hpp"

namespace inkwell::drivers {

class LogicSupply {
 public:
  static constexpr std::array claims{peripheral<registers::EXTI>(), interrupt(Interrupt::voltage_detector)};

  /// Call this function after start_clocks(), which enables the clock of the detector.
  static void start() {
    using registers::PWR;
    constexpr std::uint32_t falls_at_2_92_V = 0b110;  // data sheet, V_PVD; the rising threshold is 3.03 V
    PWR::CR::modify(PWR::CR::PLS(falls_at_2_92_V), PWR::CR::PVDE(1));
  }

  /// Enables the interrupt for a low supply.
  static void arm() {
    Lines::RTSR::write(detector);  // the detector output is high while the supply is low
    Lines::IMR::write(detector);
    InterruptLine<LogicSupply, Interrupt::voltage_detector>::enable();
  }

  /// Returns true if the supply is below 2.9 V. The threshold is 0.1 V above the brown-out level. The reference
  /// voltages of the sensors fall with the supply.
  static bool is_low() { return registers::PWR::CSR::PVDO::is_set(); }

  /// Call this function in the voltage detector interrupt. Returns false if the supply is no longer low.
  INKWELL_INTERRUPT static bool acknowledge_interrupt() {
    Lines::PR::write(detector);
    return is_low();
  }

 private:
  using Lines = RegistersOf<LogicSupply, registers::EXTI>;
  static constexpr std::uint32_t detector = 1u << 16;  // RM0090, "External interrupt/event line mapping"
};

}  // namespace inkwell::drivers
