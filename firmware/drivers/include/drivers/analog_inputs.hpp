// Everything analogue. One driver, because ADC1 serves two of the roles:
//
//   motor currents      ADC1, ADC2, ADC3 together, injected by the update of TIM1; ADC1 interrupts at their end
//   gimbal, supply and  regular sequence of ADC1, started in every control period, stored by DMA2 stream 0
//   internal reference
//
// From the update to the middle of the sampling window there are at most 0.2 us. In that time, at 1 A, resistance
// alone changes the current by 2 mA in the smallest motor, one step of the ADC: the instant needs no correction.
#pragma once

#include <array>
#include <cstdint>

#include <drivers/claims.hpp>
#include <registers/peripherals.hpp>

namespace inkwell::drivers {

class AnalogInputs {
 public:
  static constexpr std::array claims{peripheral<registers::ADC1>(),
                                     peripheral<registers::ADC2>(),
                                     peripheral<registers::ADC3>(),
                                     peripheral<registers::ADC_COMMON>(),
                                     stream<registers::DMA2, 0>(),
                                     interrupt(Interrupt::analog_converters),
                                     pin(board::facts.motor_current[0]),
                                     pin(board::facts.motor_current[1]),
                                     pin(board::facts.motor_current[2]),
                                     pin(board::facts.gimbal[0]),
                                     pin(board::facts.gimbal[1]),
                                     pin(board::facts.gimbal[2]),
                                     pin(board::facts.supply)};

  /// Before TIM1 runs: the converters miss a trigger that comes before their clocks.
  void start_clocks();

  /// Connects the pins and sets the sequences up.
  void start();

  /// Switches the converters on and lets TIM1 trigger them. Call it well before an update, so that all three are
  /// accurate by then and hear the same one first.
  void arm();

  struct Currents {
    std::array<float, 3> current_A;  ///< from leg A to leg B of each bridge, offsets of the amplifiers included
    bool are_new;                    ///< each converter has measured since they were last taken
  };
  /// At the last update. Acknowledges the interrupt.
  Currents take_currents();

  /// Starts the conversion of gimbal, supply and reference, which takes 36 us; call it once in a control period. If
  /// conversions stop coming, it sets converter and stream up again.
  void start_slow_conversions();

  /// Voltage of the gimbal's potentiometers over that of their supply, 0..1.
  std::array<float, 3> gimbal_ratio() const;
  float supply_V() const;
  /// As the converter shows them: for whom floats cost too much.
  std::uint16_t supply_counts() const { return slow_[4]; }
  /// The chip's internal reference; 0 before it was first measured.
  std::uint16_t reference_counts() const { return slow_[3]; }
  /// What the chip's maker has read of it with a VDDA of 3.3 V; 65535 if that was erased.
  static std::uint16_t calibrated_reference_counts();
  /// Control periods for which gimbal and supply have not been measured anew; 0 or 1 while all is well.
  std::uint32_t slow_age_periods() const { return slow_age_periods_; }

 private:
  void stop_slow();
  void set_up_slow();

  /// Gimbal, internal reference, supply. Written by the DMA controller, which reaches the main RAM only.
  std::array<volatile std::uint16_t, 5> slow_{};
  std::uint32_t slow_age_periods_ = 0;
  bool slow_stopped_ = true;  ///< to be set up in the next period: at the start, or again
};

}  // namespace inkwell::drivers
