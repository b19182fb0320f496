// The three motor bridges: TIM1 drives legs A, TIM8 legs B, synchronised and centre-aligned.
//
// Counter and events of both timers in one control period (three PWM periods):
//
//   top   /\    /\    /\     |  each leg is high while the counter is below its compare value
//        /  \  /  \  /  \    |
//   0   /    \/    \/    \/  |
//       |                 |
//       update            update: preloaded compare values of all six legs become active, ADCs sample
//
// The update comes at a turning point, in the middle of a zero vector, where the ripple current crosses its mean.
#pragma once

#include <array>
#include <cstdint>

#include <drivers/claims.hpp>
#include <registers/peripherals.hpp>

namespace inkwell::drivers {

class Bridges {
 public:
  static constexpr std::array claims{
      peripheral<registers::TIM1>(),      peripheral<registers::TIM8>(),      pin(board::facts.bridge_enable),
      pin(board::facts.bridge_heartbeat), pin(board::facts.bridge_hold),      pin(board::facts.bridges[0].leg_a),
      pin(board::facts.bridges[1].leg_a), pin(board::facts.bridges[2].leg_a), pin(board::facts.bridges[0].leg_b),
      pin(board::facts.bridges[1].leg_b), pin(board::facts.bridges[2].leg_b), pin(board::facts.bridge_fault_tim1),
      pin(board::facts.bridge_fault_tim8)};

  /// Sets up both timers and lets them run with all outputs off. Their update triggers the ADCs from now on.
  void start();

  /// Preloads no voltage for all motors: what the motors get if the control interrupt does not finish in time.
  void write_neutral();

  /// Preloads duties of -1..1, which become active with the next update.
  void write(const std::array<float, 3>& duty);

  /// Preloads all low sides on: a motor that turns is braked by its own voltage.
  void write_brake();

  /// Lets the bridges switch. Does nothing if they do already, so that a fault cannot be cleared by accident.
  void enable();

  /// All six legs low and the bridges' enable wire low, at once.
  void disable();

  /// The fault wire has been low since the bridges were enabled, or is low now.
  bool fault() const;

  /// Whether the fault wire does as the own pulls of TIM1's pin, or of TIM8's, do: it reaches neither bridges nor its
  /// pull-up. While the bridges are off; no interrupt, which might take that for a fault, comes for 8 us.
  bool fault_wire_of_tim1_floats() const;
  bool fault_wire_of_tim8_floats() const;
  /// What the enable wire, the heartbeat's, the monostable's output and the legs' wires are, at the chip's pins,
  /// whoever drives them there.
  bool enable_is_high() const;
  bool heartbeat_is_high() const;
  bool hold_is_high() const;
  bool a_leg_is_high() const;
  /// As the control interrupt has left them.
  bool are_on() const { return enabled_; }

  /// An update came since the last call of begin_period(): called at the end of the control interrupt, it tells
  /// that the interrupt took longer than its period.
  bool period_is_over() const { return RegistersOf<Bridges, registers::TIM1>::SR::UIF::is_set(); }
  /// If the bridges are on the heartbeat rises: they may stay so for `bridge_hold_s`.
  /// True if they were to be on and had been let go: the heartbeat before came too long ago, or did not reach them.
  [[nodiscard]] bool begin_period();
  /// The heartbeat falls, so that it can rise again.
  void end_period();

  /// Waits for the next update, at most two control periods. False if one of the timers does not run.
  [[nodiscard]] bool wait_for_update();

 private:
  bool enabled_ = false;
};

}  // namespace inkwell::drivers
