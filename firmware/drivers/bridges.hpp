// The three motor bridges. TIM1 drives legs A and TIM8 drives legs B, synchronized and center-aligned.
//
// Each leg is high while the counter is below its compare value. The diagram shows the counter of both timers in one
// control period (three PWM periods).
//
//   Top  |   /\    /\    /\    |
//        |  /  \  /  \  /  \   |
//   0    | /    \/    \/    \  |
//          |                 |
//          update            update.
//
// At the update, the preloaded compare values of all six legs become active, and the ADCs sample.
//
// The update occurs at a counter reversal, in the middle of a zero vector, when the ripple current crosses its mean.
#pragma once

#include <array>
#include <cstdint>

#include "firmware/drivers/claims.hpp"
#include "firmware/registers/peripherals.hpp"

namespace inkwell::drivers {

class Bridges {
 public:
  static constexpr std::array claims{
      peripheral<registers::TIM1>(),      peripheral<registers::TIM8>(),      pin(board::facts.bridge_enable),
      pin(board::facts.bridge_heartbeat), pin(board::facts.bridge_hold),      pin(board::facts.bridges[0].leg_a),
      pin(board::facts.bridges[1].leg_a), pin(board::facts.bridges[2].leg_a), pin(board::facts.bridges[0].leg_b),
      pin(board::facts.bridges[1].leg_b), pin(board::facts.bridges[2].leg_b), pin(board::facts.bridge_fault_tim1),
      pin(board::facts.bridge_fault_tim8)};

  /// Sets up both timers and starts them with all outputs off. After this call the update triggers the ADCs.
  void start();

  /// Preloads zero voltage for all motors. The motors get zero voltage if the control interrupt does not finish in
  /// time.
  void write_neutral();

  /// Preloads duty cycles of -1..1, which become active at the next update.
  void write(const std::array<float, 3>& duty);

  /// Preloads the brake state, in which all low sides are on and the back EMF brakes the motors.
  void write_brake();

  /// Switches the bridges on. The function has no effect while the bridges are on, so that a fault is not cleared by
  /// accident.
  void enable();

  /// Sets all six legs and the enable wire of the bridges low immediately.
  void disable();

  /// Returns true if the fault wire is low, or has been low since the bridges were enabled.
  bool fault() const;

  /// Returns true if the fault wire follows the internal pull resistors at the pin of TIM1 or TIM8. In this case the
  /// pin is not connected to the bridges or to the external pull-up. Call this function while the bridges are off. The
  /// function disables interrupts for 8 us, because an interrupt could interpret the low level as a fault.
  bool fault_wire_of_tim1_floats() const;
  bool fault_wire_of_tim8_floats() const;
  /// Levels of the enable wire, the heartbeat wire, the monostable output and the leg wires at the chip's pins. Other
  /// circuits may drive these wires too.
  bool enable_is_high() const;
  bool heartbeat_is_high() const;
  bool hold_is_high() const;
  bool a_leg_is_high() const;
  /// True if the control interrupt has switched the bridges on.
  bool are_on() const { return enabled_; }

  /// Returns true if an update occurred after the last begin_period(). If this function returns true at the end of the
  /// control interrupt, the interrupt took longer than its period.
  bool period_is_over() const { return RegistersOf<Bridges, registers::TIM1>::SR::UIF::is_set(); }
  /// Raises the heartbeat if the bridges are on. Each heartbeat permits the bridges to stay on for `bridge_hold_s`.
  /// Returns true if the bridges should be on but were switched off. The cause is a late heartbeat or a broken
  /// heartbeat wire.
  [[nodiscard]] bool begin_period();
  /// Lowers the heartbeat, so that the next period can raise it.
  void end_period();

  /// Waits at most two control periods for the next update. Returns false if one of the timers does not run.
  [[nodiscard]] bool wait_for_update();

 private:
  bool enabled_ = false;
};

}  // namespace inkwell::drivers
