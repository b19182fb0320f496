// Driver of all analog inputs. One driver handles all inputs, because ADC1 converts both motor currents and slow
// inputs.
//
// The update of TIM1 starts the injected conversions of the motor currents in ADC1, ADC2 and ADC3. ADC1 raises an
// interrupt at the end of the injected conversions. The regular sequence of ADC1 converts gimbal, supply and internal
// reference in every control period. DMA2 stream 0 stores the results of the sequence.
//
// The ADCs sample at most 0.2 us after the update. In 0.2 us a motor current of 1 A changes by at most one ADC step of
// 2 mA. The sampling instant needs no correction.
#pragma once

#include <array>
#include <cstdint>

#include "firmware/drivers/claims.hpp"
#include "firmware/registers/peripherals.hpp"

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

  /// Call this function before TIM1 runs, because the converters miss triggers without clocks.
  void start_clocks();

  /// Connects the pins and sets up the sequences.
  void start();

  /// Switches the converters on and enables their trigger from TIM1. Call this function well before an update, so that
  /// all three converters respond to the same update.
  void arm();

  struct Currents {
    std::array<float, 3> current_A;  ///< from leg A to leg B of each bridge; includes the amplifier offsets
    bool are_new;                    ///< each converter has measured since the previous call
  };
  /// Returns the currents at the last timer update. Acknowledges the interrupt.
  Currents take_currents();

  /// Starts the conversion of gimbal, supply and reference. The conversion takes 36 us. Call this function once per
  /// control period. After a failure of the conversions, the function sets up converter and stream again.
  void start_slow_conversions();

  /// Wiper voltages of the gimbal potentiometers relative to their supply, 0..1.
  std::array<float, 3> gimbal_ratio() const;
  float supply_V() const;
  /// Bridge supply in converter counts.
  std::uint16_t supply_counts() const { return slow_[4]; }
  /// Converter counts of the internal reference, or 0 before the first measurement.
  std::uint16_t reference_counts() const { return slow_[3]; }
  /// Factory reading of the internal reference at VDDA = 3.3 V, or 65535 if this reading was erased.
  static std::uint16_t calibrated_reference_counts();
  /// Number of control periods without a new measurement of gimbal and supply. The value is 0 or 1 in normal operation.
  std::uint32_t slow_age_periods() const { return slow_age_periods_; }

 private:
  void stop_slow();
  void set_up_slow();

  /// Readings of gimbal, internal reference and supply. The DMA controller writes these readings, so the object must be
  /// in main RAM.
  std::array<volatile std::uint16_t, 5> slow_{};
  std::uint32_t slow_age_periods_ = 0;
  bool slow_runs_ = false;  ///< false at start-up and after an error; set up in the next period
};

}  // namespace inkwell::drivers
