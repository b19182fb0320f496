// One step of a guide, and the findings of the steps.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "host/client/device/scope_decoder.hpp"
#include "host/client/guides/device_port.hpp"

namespace inkwell::guides {

struct Check {
  std::string name;
  double value = 0;
  std::string unit;
  std::string expected;  ///< in words; empty without an expected value
  bool passed = false;
};

/// Formats a value with four digits and its unit: "0.1234 rad".
std::string measured_text(const Check& check);

/// A proposed parameter change. Guide::apply sends the proposal.
struct Proposal {
  protocol::Parameter parameter;
  float held;  ///< value of the device at the time of the measurement
  float proposed;
  std::string reason;
};

/// A curve to draw: a measured quantity over time.
struct Curve {
  std::string name;
  std::vector<std::pair<double, double>> points;  ///< time in ms, current in A
};

struct Findings {
  std::vector<std::string> sentences;
  std::vector<Proposal> proposals;
  std::vector<Curve> curves;
  nlohmann::ordered_json details = nlohmann::ordered_json::object();  ///< all numbers, for programs

  /// Proposes `value` if it differs from the device's value. Throws device::Error if `value` is out of range.
  void propose(const protocol::ParameterSet& held, protocol::Parameter parameter, double value,
               const std::string& reason);
};

/// The user's task in a step. `number` is a joint, gimbal axis or button, counted from 1.
struct UserTask {
  enum class Kind : std::uint8_t {
    none,
    rest_in_inkwell,
    hold_loosely,  ///< just outside the inkwell
    turn_joint_forward,
    move_joint_to_stops,  ///< to the lower stop, to the upper stop, then press button 1
    turn_gimbal_to_stops,
    centre_gimbal,  ///< to the middle of its range, then press button 1
    press_button,
  };
  Kind kind = Kind::none;
  int number = 0;
  bool operator==(const UserTask&) const = default;
};

/// Call begin once. Then call advance repeatedly until advance returns true. Every failure is a device::Error with
/// cause and remedy.
class Step {
 public:
  virtual ~Step() = default;
  virtual std::string title() const = 0;
  /// Description of the step and of the user's part; available before begin.
  virtual std::string text() const = 0;
  /// Returns true if the user must agree first, because a current will flow or the arm will move.
  virtual bool needs_consent() const { return false; }
  virtual UserTask user_task() const { return {}; }

  virtual void begin(const Observation&, DevicePort&) {}
  virtual void receive(const device::ScopeSamples&) {}
  virtual bool advance(const Observation& now, DevicePort& port) = 0;
  /// Returns true if the user must confirm an action in this step.
  virtual bool takes_confirmation() const { return false; }
  virtual void confirm() {}
  /// Previous values of temporarily changed parameters. The guide restores these values at the end of the step,
  /// including after a failure.
  virtual std::vector<device::ParameterChange> to_put_back() const { return {}; }

  virtual std::vector<Check> checks() const { return {}; }
  virtual double progress() const { return 0; }  ///< 0..1 if known
};

/// Board time since the start, measured with poses.
class Stopwatch {
 public:
  void start(const device::Pose& pose) { began_ = pose.time_periods; }
  double seconds(const device::Pose& pose) const { return device::board_time_s(pose.time_periods - began_); }

 private:
  std::int64_t began_ = 0;
};

}  // namespace inkwell::guides
