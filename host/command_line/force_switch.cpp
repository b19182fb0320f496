#include "force_switch.hpp"

#include <string>

#include <fmt/format.h>

#include <device/fault_text.hpp>
#include <protocol/faults.hpp>

#include "next_pose.hpp"

namespace inkwell::command_line {
namespace {

using protocol::Command;
using protocol::PoseReport;
using protocol::State;

/// Of board time: a device that does not know yet where it is forgets that it was asked.
constexpr std::uint32_t ask_again_periods = protocol::servo_rate_Hz / 10,
                        patience_periods = 2 * protocol::servo_rate_Hz;

/// Sends the command again and again until the state is the one that is wanted, or a fault, or time is over.
template <class Wanted>
PoseReport ask(device::Device& device, Command command, Wanted wanted) {
  device.send(command);
  PoseReport pose = next_pose(device);
  const std::uint32_t begin_periods = pose.time_periods;
  std::uint32_t asked_periods = begin_periods;
  while (!wanted(pose.state) && pose.state != State::fault && pose.time_periods - begin_periods < patience_periods) {
    if (pose.time_periods - asked_periods >= ask_again_periods) {
      device.send(command);
      asked_periods = pose.time_periods;
    }
    device.keep_alive();
    pose = next_pose(device);
  }
  return pose;
}

}  // namespace

void switch_force_on(device::Device& device) {
  const auto pose = ask(device, Command::enable_force, [](State state) { return state == State::active; });
  if (pose.state == State::active) return;
  if (pose.state == State::ready) throw device::Error("The device did not switch the force on in time. Try again.");
  throw device::Error(force_sentence(pose));
}

PoseReport switch_force_off(device::Device& device) {
  const auto pose = ask(device, Command::disable_force, [](State state) { return state != State::active; });
  if (pose.state == State::active)
    throw device::Error("The force is still on: another program switches it on again. End that first.");
  return pose;
}

std::string force_sentence(const PoseReport& pose) {
  switch (pose.state) {
    case State::active: return "The force is on.";
    case State::ready: return "The force is off.";
    case State::fault: return "The force is off. " + device::fault_line(pose.fault);
    default: return fmt::format("The force is off. {}", info(pose.state).meaning);
  }
}

std::string why_force_went_off(const PoseReport& pose) {
  const std::string went_off = "The force went off. ";
  if (pose.state == State::ready) return went_off + "Another program or a window has switched it off.";
  if (pose.state == State::fault) return went_off + device::fault_line(pose.fault);
  return went_off + std::string(info(pose.state).meaning);
}

}  // namespace inkwell::command_line
