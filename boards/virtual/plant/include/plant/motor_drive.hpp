// One motor on its full bridge: terminal voltage from the legs, current between switching edges in closed
// form, so that the ripple, the discontinuous current of a floating bridge and the dead time are really there.
#pragma once

#include <array>
#include <optional>

#include <chip/interfaces.hpp>
#include <plant/imperfections.hpp>

namespace inkwell::virtual_board {

/// What a gate driver is told to do with one leg. `floating` leaves the current to the diodes.
enum class Leg : std::uint8_t { low, high, floating };

/// What a leg is whatever it is told.
enum class LegFault : std::uint8_t { none, high, low, open };

struct MotorConstants {
  double resistance_ohm;  ///< winding and shunt
  double inductance_H;
};

class MotorDrive {
 public:
  MotorDrive(const MotorConstants& motor, const Imperfections& imperfections, double dead_time_s);

  /// Tells leg 0 (A, motor terminal +) or 1 (B) what to do from `now` on; it obeys after the dead time. Runs
  /// the current up to `now` first.
  void set_leg(unsigned leg, Leg level, Ticks now);

  /// Another winding in the same motor, from `now` on; none conducts nothing.
  void set_winding(const std::optional<MotorConstants>& motor, Ticks now);
  void set_leg_fault(unsigned leg, LegFault fault, Ticks now);
  /// This much after the dead time the leg's switches conduct.
  void set_leg_delay(unsigned leg, Ticks delay);

  /// Integrates the current up to `now`. Times do not run backward.
  void advance(Ticks now);

  /// Supply and back-EMF hold from the last advance() on.
  void set_bus_V(double volts) { bus_V_ = volts; }
  void set_back_emf_V(double volts) { back_emf_V_ = volts; }

  double current_A() const { return current_A_; }
  /// The current as the shunt amplifier follows it, before offset, gain error and noise.
  double amplifier_A() const { return amplifier_A_; }

  /// Integrals since the last call: of the current, and of what the bridge drew from the supply.
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
  /// A voltage behind no resistance that drives the current until it changes its sign or a leg switches.
  struct Branch {
    double voltage_V;     ///< from terminal + to terminal -, without the legs' resistance
    double supply_share;  ///< supply current over motor current: -1, 0 or 1
    bool conducts;
    bool holds_at_zero;  ///< diodes block once the current has fallen to nothing
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
