#include "host/companion/command_line/force_switch.hpp"

#include <cstdint>
#include <string>

#include <fmt/format.h>

#include "host/client/device/clear_fault.hpp"
#include "host/client/device/fault_text.hpp"
#include "protocol/faults.hpp"

#include "host/companion/command_line/next_pose.hpp"

namespace inkwell::command_line {
namespace {

using device::Pose;
using protocol::Command;
using protocol::State;

/// Intervals in board time. An unreferenced device ignores the request, so the program repeats the request.
constexpr std::int64_t retry_periods = protocol::servo_rate_Hz / 10, patience_periods = 2 * protocol::servo_rate_Hz;

/// Repeats the command until the desired state is reached, a fault occurs, or the time limit expires.
template <class Wanted>
Pose send_until(device::Device& device, Command command, Wanted wanted) {
  device.carry_out(command);
  Pose pose = next_pose(device);
  const std::int64_t begin_periods = pose.time_periods;
  std::int64_t sent_periods = begin_periods;
  while (!wanted(pose.state) && pose.state != State::fault && pose.time_periods - begin_periods < patience_periods) {
    if (pose.time_periods - sent_periods >= retry_periods) {
      device.carry_out(command);
      sent_periods = pose.time_periods;
    }
    device.keep_alive();
    pose = next_pose(device);
  }
  return pose;
}

/// Clears a fault that occurred because a previous program exited without switching the force off.
void clear_what_a_host_left(device::Device& device) {
  Pose pose = next_pose(device);
  if (pose.state != State::fault || !device::is_left_by_a_host(pose.fault)) return;
  const auto shown = [&] { return device::ShownFault{pose.time_periods, pose.state, pose.fault}; };
  device::clear_fault(device, shown(), [&] {
    device.keep_alive();
    pose = next_pose(device);
    return shown();
  });
}

/// Returns a space and the reason why the force is off. Returns an empty text if the device is ready.
std::string what_keeps_it_off(const Pose& pose) {
  if (pose.state == State::ready) return {};
  return " " + (pose.state == State::fault ? device::fault_line(pose.fault) : std::string(info(pose.state).meaning));
}

}  // namespace

Pose switch_force_off(device::Device& device) {
  device.switch_force_off();
  // The queue may still contain older poses, in which the force is on.
  Pose pose = next_pose(device);
  const std::int64_t begin_periods = pose.time_periods;
  while (protocol::force_is_on(pose.state) && pose.time_periods - begin_periods < patience_periods)
    pose = next_pose(device);
  return pose;
}

ForceSwitch::ForceSwitch(device::Device& device) : device_(device) {
  device.claim();
  clear_what_a_host_left(device);
  const auto pose = send_until(device, Command::enable_force, [](State state) { return protocol::force_is_on(state); });
  if (protocol::force_is_on(pose.state)) return;
  if (pose.state == State::ready) throw device::Error("The device did not switch the force on in time. Try again.");
  throw device::Error(force_sentence(pose));
}

ForceSwitch::~ForceSwitch() {
  try {
    if (may_be_on_) switch_off();
  } catch (const device::Error&) {  // the device is gone or silent; the board switches the force off automatically
  }
}

Pose ForceSwitch::switch_off() {
  may_be_on_ = false;
  return device_.drives() ? switch_force_off(device_) : next_pose(device_);
}

std::optional<std::string> ForceSwitch::loss(const Pose& pose) const {
  if (!device_.drives())
    if (const auto driver = device_.driver())
      return fmt::format("The arm was taken over by {}.", device::driver_text(*driver));
  if (protocol::force_is_on(pose.state)) return std::nullopt;
  return "The force went off." + (pose.state == State::ready ? " Another program or a window switched the force off."
                                                             : what_keeps_it_off(pose));
}

std::string force_sentence(const Pose& pose) {
  return protocol::force_is_on(pose.state) ? "The force is on." : "The force is off." + what_keeps_it_off(pose);
}

}  // namespace inkwell::command_line
