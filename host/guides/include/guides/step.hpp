// One step of a guide, and what steps leave behind for the guide's result.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include <device/scope_decoder.hpp>
#include <guides/device_port.hpp>

namespace inkwell::guides {

/// A measured number that is shown while a step runs.
struct Check {
  std::string name;
  double value = 0;
  std::string unit;
  std::string expected;  ///< in words; empty if there is nothing to compare with
  bool passed = false;
};

/// "0.1234 rad": the value to four digits, with its unit.
std::string measured_text(const Check& check);

/// A change that a guide proposes. Nothing reaches the device before Guide::apply.
struct Proposal {
  protocol::Parameter parameter;
  float held;  ///< by the device when the guide measured
  float proposed;
  std::string reason;
};

/// A line to be drawn: what was measured over time.
struct Curve {
  std::string name;
  std::vector<std::pair<double, double>> points;  ///< time in ms, current in A
};

struct Findings {
  std::vector<std::string> sentences;
  std::vector<Proposal> proposals;
  std::vector<Curve> curves;
  nlohmann::ordered_json details = nlohmann::ordered_json::object();  ///< every number, for programs

  /// Proposes `value` if it differs from what the device holds. Throws device::Error if it is outside the range.
  void propose(const protocol::ParameterSet& held, protocol::Parameter parameter, double value,
               const std::string& reason);
};

/// What the user is to do in a step; a simulated hand can read it, too. `number` is a joint, gimbal axis or button
/// from 1 on.
struct UserTask {
  enum class Kind : std::uint8_t {
    none,
    rest_in_inkwell,
    hold_loosely,  ///< a little out of the inkwell
    turn_joint_forward,
    move_joint_to_stops,  ///< the lower, the upper, then button 1
    turn_gimbal_to_stops,
    centre_gimbal,  ///< to the middle of its range, then button 1
    press_button,
  };
  Kind kind = Kind::none;
  int number = 0;
  bool operator==(const UserTask&) const = default;
};

/// Called in the order begin, advance again and again until it returns true. Every failure is a device::Error with
/// cause and remedy.
class Step {
 public:
  virtual ~Step() = default;
  virtual std::string title() const = 0;
  /// What is going to happen and what the user does; known before begin.
  virtual std::string text() const = 0;
  /// A current will flow or something will move by itself, so the user must agree first.
  virtual bool asks_first() const { return false; }
  virtual UserTask user_task() const { return {}; }

  virtual void begin(const Observation&, DevicePort&) {}
  virtual void receive(const device::ScopeSamples&) {}
  virtual bool advance(const Observation& now, DevicePort& port) = 0;
  /// The user says that his part is done; only asked of a step that has such a part.
  virtual bool takes_confirmation() const { return false; }
  virtual void confirm() {}
  /// Old values of the parameters that the step changed on the device for a while. The guide sends them when the step
  /// is over, however it ended.
  virtual std::vector<device::ParameterChange> to_put_back() const { return {}; }

  virtual std::vector<Check> checks() const { return {}; }
  virtual double progress() const { return 0; }  ///< 0..1 where it is known
};

/// Board time since it was started, by the poses.
class Stopwatch {
 public:
  void start(const device::Pose& pose) { began_ = pose.time_periods; }
  double seconds(const device::Pose& pose) const { return device::board_time_s(pose.time_periods - began_); }

 private:
  std::int64_t began_ = 0;
};

}  // namespace inkwell::guides
