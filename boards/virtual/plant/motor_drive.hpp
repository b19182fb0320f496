// One motor with its full bridge. The legs set the terminal voltage. Between switching edges the current is computed in
// closed form. The model therefore includes ripple, dead time and the discontinuous current of a floating bridge.
#pragma once

#include <array>
#include <optional>

#include "boards/stm32f405/core/interfaces.hpp"
#include "boards/virtual/plant/imperfections.hpp"

namespace inkwell::virtual_board {

/// Command to the gate driver of one leg. If a leg is `floating`, its diodes conduct the current.
enum class Leg : std::uint8_t { low, high, floating };

enum class LegFault : std::uint8_t { none, high, low, open };

struct MotorConstants {
  double resistance_ohm;  ///< winding and shunt
  double inductance_H;
};

class MotorDrive {
 public:
  MotorDrive(const MotorConstants& motor, const Imperfections& imperfections, double dead_time_s);

  /// Sets the command of leg 0 (A, motor terminal +) or leg 1 (B) from `now` on. The leg switches after the dead time.
  /// This function first advances the current to `now`.
  void set_leg(unsigned leg, Leg level, Ticks now);

  /// Replaces the winding of the motor at `now`; std::nullopt is an open winding.
  void set_winding(const std::optional<MotorConstants>& motor, Ticks now);
  void set_leg_fault(unsigned leg, LegFault fault, Ticks now);
  /// Sets a delay that is added to the dead time of the leg.
  void set_leg_delay(unsigned leg, Ticks delay);

  /// Integrates the current up to `now`. The argument `now` never decreases.
  void advance(Ticks now);

  /// The values apply from the time of the last advance() on.
  void set_bus_V(double volts) { bus_V_ = volts; }
  void set_back_emf_V(double volts) { back_emf_V_ = volts; }

  double current_A() const { return current_A_; }
  /// Returns the low-pass filtered current without offset, gain error and noise.
  double amplifier_A() const { return amplifier_A_; }

  /// Integrals of the motor current and the supply current since the last call.
  struct Charges {
    double motor_As;
    double supply_As;
  };
  Charges take_charges();

 private:
  struct LegState {
    Leg wanted = Leg::floating;
    Leg actual = Leg::floating;
    Ticks settles_at = 0;  ///< end of the dead time, while `actual` is not `wanted`
    Ticks delay = 0;
    LegFault fault = LegFault::none;
    Leg acting() const;
  };
  void configure(const MotorConstants& motor);
  /// Equivalent voltage source of the bridge. The values change when the current changes sign or a leg switches.
  struct Branch {
    double voltage_V;     ///< from terminal + to terminal -, without the leg resistance
    double supply_share;  ///< ratio of supply current to motor current: -1, 0 or 1
    bool conducts;
    bool holds_at_zero;  ///< the diodes block once the current is zero
  };
  Branch branch() const;
  void integrate(Ticks duration);
  void run(double duration_s, double decay, double amplifier_decay, const Branch& branch);

  double legs_ohm_, amplifier_s_;
  bool conducts_ = true;
  double resistance_ohm_ = 0.0, time_constant_s_ = 0.0, inverse_resistance_ = 0.0, diode_drop_V_;
  double amplifier_time_constant_s_ = 0.0, amplifier_lead_ = 0.0;
  Ticks dead_time_;
  double dead_time_decay_ = 0.0, dead_time_amplifier_decay_ = 0.0;

  std::array<LegState, 2> legs_{};
  Ticks now_ = 0;
  double bus_V_ = 0.0, back_emf_V_ = 0.0;
  double current_A_ = 0.0, amplifier_A_ = 0.0;
  Charges charges_{};
};

}  // namespace inkwell::virtual_board
