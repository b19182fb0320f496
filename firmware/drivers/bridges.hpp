// The three motor bridges. TIM1 drives the legs A, and TIM8 drives the legs B. The center-aligned timers run
// synchronously.
//
// A leg is high while the counter is below the leg's compare value. The diagram shows the counter of both timers in one
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
// At the update, in the middle of a zero vector, the ripple current crosses its mean.
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

  /// Sets up both timers and starts them with all outputs off. After this call, each timer update triggers the ADCs.
  void start();

  /// Preloads zero voltage for all motors. The motors get zero voltage if the control interrupt does not finish in
  /// time.
  void write_neutral();

  /// Preloads duty cycles of -1..1 for the next update.
  void write(const std::array<float, 3>& duty);

  /// Preloads the brake state, in which all low sides are on.
  void write_brake();

  /// Switches the bridges on. If the bridges are already on, a call does not clear a fault.
  void enable();

  /// Sets all six legs and the enable wire of the bridges low immediately.
  void disable();

  /// Returns true if the fault wire is low, or was low after the bridges had been enabled.
  bool fault() const;

  /// Returns true if the fault wire is disconnected, so that the internal pull resistors can change its level. Call
  /// this function while the bridges are off. The function disables interrupts for 8 us, because an interrupt could
  /// interpret the low level as a fault.
  bool fault_wire_of_tim1_floats() const;
  bool fault_wire_of_tim8_floats() const;
  /// Levels at the chip's pins.
  bool enable_is_high() const;
  bool heartbeat_is_high() const;
  bool hold_is_high() const;
  bool a_leg_is_high() const;
  /// Returns true if the control interrupt has switched the bridges on.
  bool are_on() const { return enabled_; }

  /// Returns true if a timer update occurred after the last begin_period(). If the result is true at the end of the
  /// control interrupt, the interrupt has taken longer than one period.
  bool period_is_over() const { return RegistersOf<Bridges, registers::TIM1>::SR::UIF::is_set(); }
  /// Raises the heartbeat if the bridges are on. Each heartbeat permits the bridges to stay on for `bridge_hold_s`.
  /// Returns true if the monostable has switched the bridges off, because of a late heartbeat or a broken heartbeat
  /// wire.
  [[nodiscard]] bool begin_period();
  /// Lowers the heartbeat until the next period.
  void end_period();

  /// Waits at most two control periods for the next update. Returns false if one of the timers does not run.
  [[nodiscard]] bool wait_for_update();

 private:
  bool enabled_ = false;
};

}  // namespace inkwell::drivers
