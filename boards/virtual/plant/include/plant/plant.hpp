// Everything around the chip: bridges and motors, sensors, the arm, the inkwell and the user's hand, wired as a
// board's facts say.
//
// Currents are exact between the edges of the bridges; the arm, the supply and the back-EMF take fixed steps
// of 16.7 us (a third of a control period) with the mean of the true currents. Pins of the chip move only
// inside advance(), so that a chip may call output_changed() and analog_V() from anywhere.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <random>

#include <board/facts.hpp>
#include <chip/interfaces.hpp>
#include <plant/arm_motion.hpp>
#include <plant/hand.hpp>
#include <plant/hand_meter.hpp>
#include <plant/imperfections.hpp>
#include <plant/monostable.hpp>
#include <plant/motor_drive.hpp>
#include <plant/motor_fault.hpp>
#include <plant/motor_force_meter.hpp>
#include <plant/quadrature_encoder.hpp>
#include <plant/shunt_fault.hpp>
#include <plant/supply.hpp>
#include <plant/truth.hpp>

namespace inkwell::virtual_board {

struct PlantOptions {
  std::uint64_t seed = 1;  ///< of all noise
  Imperfections imperfections{};
};

/// Starts docked: the stylus rests in the inkwell, the supply is on, buttons are open, no hand.
class Plant final : public Circuit {
 public:
  static constexpr Ticks step_ticks = ticks_per_s / 60'000;

  /// The facts must outlive it.
  Plant(const arms::Description& arm, const board::Facts& board, const PlantOptions& options = {});

  /// Solders the chip in: from here on the plant drives its inputs, with their present levels to begin with.
  void connect(InputPins& pins);

  void output_changed(char port, unsigned pin, PinLevel level, Ticks now) override;
  double analog_V(char port, unsigned pin, Ticks now) override;
  AnalogSource analog_source(char port, unsigned pin) const override;
  void advance(Ticks now) override;

  // ---- what a person does to it, from the time of the last call of the chip on ----
  void press_buttons(bool first, bool second);
  void set_supply_V(double volts) { supply_.set_source_V(volts); }
  void set_bridge_fault(bool fault);
  /// The USB cable brings VBUS.
  void set_usb_supply(bool present);
  /// Turns the gimbal, as the hand does with the stylus: yaw, pitch, roll.
  void turn_gimbal(const Vector3& gimbal_rad) { gimbal_rad_ = gimbal_rad; }
  void hold(const Vector3& target_m, double stiffness_N_per_m, double damping_Ns_per_m);
  void let_go();
  void follow(const std::vector<Waypoint>& waypoints);
  /// Carries the stylus to the inkwell and leaves it there (the hand lets go), or takes it out of the socket.
  void dock(bool docked);
  /// Puts the arm somewhere at once, for tests.
  void place(const Vector3& joints_rad, const Vector3& joint_speeds_rad_s);

  // ---- what fails in it, from the same time on; `motor` counts from 0 ----
  EncoderFault& encoder_fault(unsigned motor) { return encoders_[motor].fault; }
  ShuntFault shunt_fault(unsigned motor) const { return shunt_faults_[motor]; }
  /// A frozen output stays at what it is now.
  void set_shunt_fault(unsigned motor, const ShuntFault& fault);
  MotorFault motor_fault(unsigned motor) const { return motor_faults_[motor]; }
  void set_motor_fault(unsigned motor, const MotorFault& fault);
  /// A leg whose one switch has fused trips its bridge when the other one is asked for: see `tripped_`.
  void set_leg_fault(unsigned motor, unsigned leg, LegFault fault);
  void set_leg_delay(unsigned motor, unsigned leg, double delay_s) {
    motors_[motor].set_leg_delay(leg, ticks(delay_s));
  }
  /// The source of the bridges gives this whatever it was set to; none heals it.
  void fail_supply_at_V(std::optional<double> volts) { supply_.fail_at_V(volts); }
  /// It swings by so much to either side, 100 times a second; 0 heals it.
  void swing_supply_by_V(double amplitude_V) { supply_.swing_by_V(amplitude_V); }
  /// What amplifiers and potentiometers are fed with, 3.3 V to begin with.
  void set_analog_supply_V(double volts) { analog_supply_V_ = volts; }

  /// Measures what the hand gets and how hard the motors press, from now on.
  void start_meters() {
    hand_meter_.start(probe_m_, now_);
    motor_force_meter_.start();
  }
  const HandMeter& hand_meter() const { return hand_meter_; }
  const MotorForceMeter& motor_force_meter() const { return motor_force_meter_; }

  Truth truth(Ticks now);
  const ArmMotion& arm() const { return arm_; }
  const Inkwell& inkwell() const { return inkwell_; }
  const Hand& hand() const { return hand_; }

 private:
  enum class Role : std::uint8_t { none, leg_a, leg_b, enable, heartbeat };
  struct Wire {
    Role role = Role::none;
    std::uint8_t motor = 0;
  };
  static constexpr unsigned wire_index(char port, unsigned pin) { return static_cast<unsigned>(port - 'A') * 16 + pin; }

  void run_until(Ticks now);
  void step();
  void finish_docking();
  void show_inputs();
  void show_hold();
  void show(char port, unsigned pin, PinLevel level, PinLevel& shown);
  void update_legs(unsigned motor, Ticks now);
  void enable_bridges(bool enabled, Ticks now);
  void let_go_of_bridges(Ticks until);
  double noise(double rms) { return rms * normal_(random_); }
  double gimbal_V(unsigned axis);
  double shunt_V(unsigned motor);
  double torque_per_A(unsigned motor) const { return torque_per_A_[motor] * motor_faults_[motor].torque_factor(); }
  bool shoots_through() const;
  void note_driving(Ticks now);

  std::array<Wire, std::size_t{16} * 9> wires_{};  ///< ports A to I

  const board::Facts& board_;

  // Electrical
  Imperfections imperfections_;
  std::array<MotorDrive, 3> motors_;
  std::array<std::array<PinLevel, 2>, 3> leg_pins_;
  bool bridges_enabled_ = false, bridge_fault_ = false;
  Monostable hold_;  ///< what `bridges_enabled_` follows
  Supply supply_;
  double supply_divided_V_;  ///< at the pin, behind the divider and its capacitor
  double analog_supply_V_;
  std::array<MotorConstants, 3> windings_;  ///< and shunts, of sound motors
  std::array<MotorFault, 3> motor_faults_{};
  std::array<ShuntFault, 3> shunt_faults_{};
  std::array<std::array<LegFault, 2>, 3> leg_faults_{};
  bool driving_ = false;  ///< a bridge that is on has a leg at the supply
  Ticks driven_until_ = 0;
  bool tripped_ = false;  ///< a bridge's over-current protection, until it is disabled

  // Mechanical
  std::array<double, 3> torque_per_A_;  ///< at the joint, sign of the wiring included
  ArmMotion arm_;
  Vector3 probe_m_;  ///< where the last step brought it
  Hand hand_;
  Hand carrier_;  ///< holds while it carries the stylus to the inkwell
  Inkwell inkwell_;
  HandMeter hand_meter_;  ///< runs with the other one
  MotorForceMeter motor_force_meter_;
  Vector3 torque_Nm_ = Vector3::Zero();

  // Inputs of the chip
  InputPins* pins_ = nullptr;
  bool inputs_stale_ = true;  ///< something that the inputs show has moved since
  Ticks shown_at_ = 0;        ///< the arm, by the encoders
  std::array<QuadratureEncoder, 3> encoders_;
  std::array<QuadratureEncoder::Levels, 3> encoder_levels_{};
  std::array<bool, 2> buttons_{};
  bool usb_supply_ = false;
  std::array<PinLevel, 7> shown_{};  ///< buttons, inkwell switch, two pins of the fault wire, USB supply, hold

  // Gimbal: joint angles and the inverse of the potentiometers' characteristic
  std::array<std::array<double, 3>, 3> gimbal_terms_;  ///< square, slope, offset of each
  Vector3 gimbal_rad_;

  double divider_follows_;  ///< how much of its way the divided supply goes in a step
  Ticks now_ = 0;
  Ticks next_step_ = step_ticks;
  std::mt19937_64 random_;
  std::normal_distribution<double> normal_{0.0, 1.0};
};

}  // namespace inkwell::virtual_board
