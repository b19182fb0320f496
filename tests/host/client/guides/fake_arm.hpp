// A fake device for guides. The device simulates windings, current loops, joints and switches, and logs all requests.
#pragma once

#include <array>
#include <cmath>
#include <optional>
#include <random>
#include <vector>

#include "boards/omni_driver/facts.hpp"
#include "host/client/guides/guide.hpp"

namespace inkwell::tests {

struct Winding {
  double resistance_ohm = 2.3;
  double inductance_H = 0.25e-3;
};

class FakeArm final : public guides::DevicePort {
 public:
  static constexpr double period_s = 1.0 / protocol::servo_rate_Hz;
  static constexpr double supply_V = board::supply_nominal_V;

  FakeArm() {
    now_.connected = true;
    now_.parameters = protocol::default_parameters();
    now_.parameters_revision = 1;
    now_.information.emplace();
    now_.information->protocol_version = protocol::protocol_version;
    now_.information->board_name = board::omni_driver.name;
    device::Pose pose{};
    pose.state = protocol::State::ready;
    pose.supply_dV = static_cast<std::uint8_t>(10 * supply_V);
    pose.switches = static_cast<std::uint8_t>(protocol::Switch::inkwell);
    for (int i = 0; i < 3; ++i)
      pose.joint_rad[i] = (*now_.parameters)[of_number(protocol::Parameter::inkwell_joint_1_rad, i + 1)];
    now_.pose = pose;
  }

  // ---- requests of the guides ----
  void send(protocol::Command command) override {
    commands.push_back(command);
    if (command == protocol::Command::disable_force) left_ = 0;
  }
  void send(protocol::Command command, const protocol::TestPulse& pulse) override {
    commands.push_back(command);
    pulses.push_back(pulse);
    if (!now_.connected || left_ > 0) return;
    pulse_ = pulse;
    is_voltage_ = command == protocol::Command::test_voltage;
    length_ = static_cast<int>(std::lround(pulse.duration_s * protocol::servo_rate_Hz));
    left_ = 2 * length_;
  }
  void set_parameters(std::vector<device::ParameterChange> changes) override {
    transactions.push_back(changes);
    if (!now_.connected) return;
    ++now_.parameters_revision;
    now_.refusal.reset();
    if (refuses) {
      now_.refusal = "The device refused it.";
      return;
    }
    for (const auto& [parameter, value] : changes) (*now_.parameters)[parameter] = value;
  }
  void select_signals(std::vector<protocol::Signal> signals) override { selected = std::move(signals); }

  // ---- actions of the test ----
  void unplug() {
    now_.connected = false;
    now_.pose.reset();
  }
  device::Pose& pose() { return *now_.pose; }
  std::string& board_name() { return now_.information->board_name; }
  protocol::ParameterSet& parameters() { return *now_.parameters; }
  const guides::Observation& now() const { return now_; }
  bool current_flows() const { return std::abs(current_A_) > 0.01; }

  /// Advances time by one millisecond and the guide by one step.
  void pass_millisecond(guides::Guide& guide) {
    if (now_.connected) {
      ++now_.pose->sequence;
      if (loses_scope) ++now_.pose->time_periods;
      device::ScopeSamples samples;
      samples.signals = selected;
      samples.first_period = now_.pose->time_periods;
      samples.count = 20;
      if (loses_scope) samples.lost_before = 1;
      for (int i = 0; i < 20; ++i) {
        step();
        for (const auto signal : selected) samples.values.push_back(static_cast<float>(value_of(signal)));
      }
      now_.pose->time_periods += 20;
      if (!selected.empty()) guide.receive(samples);
    }
    guide.advance(now_, *this);
  }
  /// Runs until the guide has finished or asks a question. Confirms every question if `agrees` is set.
  void run(guides::Guide& guide, bool agrees, int limit_ms = 10'000) {
    for (int ms = 0; ms < limit_ms && !guide.is_over(); ++ms) {
      if (guide.phase() == guides::Phase::awaits_consent) {
        if (!agrees) return;
        guide.confirm();
      }
      pass_millisecond(guide);
    }
  }

  std::vector<protocol::Command> commands;
  std::vector<protocol::TestPulse> pulses;
  std::vector<std::vector<device::ParameterChange>> transactions;
  std::vector<protocol::Signal> selected;
  Winding winding;
  bool refuses = false, loses_scope = false;
  bool motor_turns_backward = false, motor_is_stuck = false;

 private:
  void step() {
    measured_A_ = current_A_ + noise_(random_);
    const double value = left_ > length_ ? static_cast<double>(pulse_.amplitude) : 0;
    reference_A_ = 0;
    double wanted_V = 0;
    if (left_ > 0 && is_voltage_) wanted_V = value;
    if (left_ > 0 && !is_voltage_) {
      reference_A_ = value;
      const double error_A = value - measured_A_;
      integral_V_ +=
          static_cast<double>(parameters()[protocol::Parameter::current_integral_gain_V_per_As]) * error_A * period_s;
      wanted_V = static_cast<double>(parameters()[protocol::Parameter::current_proportional_gain_V_per_A]) * error_A +
                 integral_V_;
    }
    if (left_ == 0) integral_V_ = 0;
    // The new voltage becomes active one period later.
    const double decay = std::exp(-period_s * winding.resistance_ohm / winding.inductance_H);
    const double final_A = acting_V_ / winding.resistance_ohm;
    current_A_ = final_A + (current_A_ - final_A) * decay;
    acting_V_ = wanted_V;
    if (left_ > 0) --left_;
    if (!motor_is_stuck && left_ > 0) joint_offset_rad_ += 5e-4 * current_A_ / 10 * (motor_turns_backward ? -1 : 1);
  }
  double value_of(protocol::Signal signal) {
    using protocol::Signal;
    const int motor = pulse_.motor == 0 ? 1 : pulse_.motor;
    if (signal == of_number(Signal::current_1_A, motor)) return measured_A_;
    if (signal == of_number(Signal::current_reference_1_A, motor)) return reference_A_;
    if (signal == of_number(Signal::duty_1, motor)) return is_voltage_ ? acting_V_ / supply_V : 0;
    if (signal == of_number(Signal::joint_1_rad, motor)) return joint_offset_rad_;
    if (signal == Signal::supply_V) return supply_V;
    return 0;
  }

  guides::Observation now_;
  protocol::TestPulse pulse_{};
  bool is_voltage_ = true;
  int length_ = 0, left_ = 0;
  double current_A_ = 0, measured_A_ = 0, reference_A_ = 0, acting_V_ = 0, integral_V_ = 0, joint_offset_rad_ = 0;
  std::mt19937 random_{1};
  std::normal_distribution<double> noise_{0, 0.002};
};

}  // namespace inkwell::tests
