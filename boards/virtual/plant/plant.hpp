// The circuit and the mechanics around the chip: bridges, motors, sensors, arm, inkwell and hand, wired according to
// the board facts.
//
// Motor currents are exact between the switching edges of the bridges. The arm, the supply and the back-EMF advance in
// fixed steps of 16.7 us, a third of a control period. The plant changes the chip's input pins only inside advance(),
// so the chip may call output_changed() and analog_V() at any time.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <random>

#include "boards/facts/board_facts.hpp"
#include "boards/stm32f405/core/interfaces.hpp"
#include "boards/virtual/plant/arm_motion.hpp"
#include "boards/virtual/plant/hand.hpp"
#include "boards/virtual/plant/hand_meter.hpp"
#include "boards/virtual/plant/imperfections.hpp"
#include "boards/virtual/plant/monostable.hpp"
#include "boards/virtual/plant/motor_drive.hpp"
#include "boards/virtual/plant/motor_fault.hpp"
#include "boards/virtual/plant/motor_force_meter.hpp"
#include "boards/virtual/plant/quadrature_encoder.hpp"
#include "boards/virtual/plant/shunt_fault.hpp"
#include "boards/virtual/plant/supply.hpp"
#include "boards/virtual/plant/truth.hpp"

namespace inkwell::virtual_board {

struct PlantOptions {
  std::uint64_t seed = 1;
  Imperfections imperfections{};
};

/// Initial state: the stylus is in the inkwell, the supply is on, the buttons are open, and no hand holds the stylus.
class Plant final : public Circuit {
 public:
  static constexpr Ticks step_ticks = ticks_per_s / 60'000;

  /// `board` must outlive the plant.
  Plant(const arms::Description& arm, const board::Facts& board, const PlantOptions& options = {});

  /// Connects the chip. From this call on, the plant drives the chip's inputs.
  void connect(InputPins& pins);

  void output_changed(char port, unsigned pin, PinLevel level, Ticks now) override;
  double analog_V(char port, unsigned pin, Ticks now) override;
  AnalogSource analog_source(char port, unsigned pin) const override;
  void advance(Ticks now) override;

  // ---- user actions, which take effect at the time of the chip's last call to the plant ----
  void press_buttons(bool first, bool second);
  void set_supply_V(double volts) { supply_.set_source_V(volts); }
  void set_bridge_fault(bool fault);
  /// Sets whether the USB cable supplies VBUS.
  void set_usb_supply(bool present);
  /// Sets the gimbal angles yaw, pitch and roll.
  void turn_gimbal(const Vector3& gimbal_rad) { gimbal_rad_ = gimbal_rad; }
  void hold(const Vector3& target_m, double stiffness_N_per_m, double damping_Ns_per_m);
  void let_go();
  void follow(const std::vector<Waypoint>& waypoints);
  /// If `docked` is true, the hand carries the stylus to the inkwell and releases it. If `docked` is false, the hand
  /// pulls the stylus out of the inkwell.
  void dock(bool docked);
  /// Moves the arm to a position immediately, for tests.
  void place(const Vector3& joints_rad, const Vector3& joint_speeds_rad_s);

  // ---- faults, which take effect at the time of the chip's last call to the plant; `motor` counts from 0 ----
  EncoderFault& encoder_fault(unsigned motor) { return encoders_[motor].fault; }
  ShuntFault shunt_fault(unsigned motor) const { return shunt_faults_[motor]; }
  /// If `fault` freezes the amplifier output, the output retains its present value.
  void set_shunt_fault(unsigned motor, const ShuntFault& fault);
  MotorFault motor_fault(unsigned motor) const { return motor_faults_[motor]; }
  void set_motor_fault(unsigned motor, const MotorFault& fault);
  /// If one switch of a leg is fused, a command for the other switch trips the bridge (see `tripped_`).
  void set_leg_fault(unsigned motor, unsigned leg, LegFault fault);
  void set_leg_delay(unsigned motor, unsigned leg, double delay_s) {
    motors_[motor].set_leg_delay(leg, ticks(delay_s));
  }
  /// Makes the bridge supply deliver this voltage. std::nullopt restores the voltage of set_supply_V().
  void fail_supply_at_V(std::optional<double> volts) { supply_.fail_at_V(volts); }
  /// Makes the supply voltage oscillate at 100 Hz. An amplitude of 0 clears the fault.
  void swing_supply_by_V(double amplitude_V) { supply_.swing_by_V(amplitude_V); }
  /// Sets the supply voltage of the amplifiers and potentiometers. The initial voltage is 3.3 V.
  void set_analog_supply_V(double volts) { analog_supply_V_ = volts; }

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
  Monostable hold_;  ///< source of `bridges_enabled_`
  Supply supply_;
  double supply_divided_V_;  ///< at the pin, after the divider and its capacitor
  double analog_supply_V_;
  std::array<MotorConstants, 3> windings_;  ///< winding and shunt of each motor without faults
  std::array<MotorFault, 3> motor_faults_{};
  std::array<ShuntFault, 3> shunt_faults_{};
  std::array<std::array<LegFault, 2>, 3> leg_faults_{};
  bool driving_ = false;  ///< an enabled bridge drives a leg high
  Ticks driven_until_ = 0;
  bool tripped_ = false;  ///< over-current protection of a bridge, until the bridge is disabled

  // Mechanical
  std::array<double, 3> torque_per_A_;  ///< at the joint, with the sign of the wiring
  ArmMotion arm_;
  Vector3 probe_m_;  ///< position after the last step
  Hand hand_;
  Hand carrier_;  ///< holds the stylus while carrying it to the inkwell
  Inkwell inkwell_;
  HandMeter hand_meter_;  ///< runs together with motor_force_meter_
  MotorForceMeter motor_force_meter_;
  Vector3 torque_Nm_ = Vector3::Zero();

  // Inputs of the chip
  InputPins* pins_ = nullptr;
  bool inputs_stale_ = true;  ///< a quantity at the inputs has changed since they were driven
  Ticks shown_at_ = 0;        ///< time of the arm position that the encoders show
  std::array<QuadratureEncoder, 3> encoders_;
  std::array<QuadratureEncoder::Levels, 3> encoder_levels_{};
  std::array<bool, 2> buttons_{};
  bool usb_supply_ = false;
  std::array<PinLevel, 7> shown_{};  ///< buttons, inkwell switch, two pins of the fault wire, USB supply, hold

  // Gimbal angles and potentiometer characteristics
  std::array<std::array<double, 3>, 3> gimbal_terms_;  ///< square, slope and offset of each potentiometer
  Vector3 gimbal_rad_;

  double divider_follows_;  ///< fraction of the voltage difference that the divided supply covers in a step
  Ticks now_ = 0;
  Ticks next_step_ = step_ticks;
  std::mt19937_64 random_;
  std::normal_distribution<double> normal_{0.0, 1.0};
};

}  // namespace inkwell::virtual_board
