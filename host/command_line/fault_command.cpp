#include "commands.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <device/fault_text.hpp>
#include <protocol/reports.hpp>

#include "help.hpp"
#include "next_pose.hpp"

namespace inkwell::command_line {
namespace {

using protocol::Fault;
using protocol::PoseReport;
using protocol::State;

void tell_fault(const DeviceOptions& options, const PoseReport& pose) {
  const bool is_fault = pose.state == State::fault;
  if (options.json)
    fmt::print("{}\n", nlohmann::ordered_json{{"state", info(pose.state).name},
                                              {"fault", info(is_fault ? pose.fault : Fault::none).name}}
                           .dump());
  else if (is_fault)
    fmt::print("{}\n", device::fault_line(pose.fault));
  else
    fmt::print("No fault. The device is {}: {}\n", info(pose.state).name, info(pose.state).meaning);
}

int show_fault(const DeviceOptions& options) {
  const auto connection = connect(options);
  tell_fault(options, next_pose(*connection.device));
  return 0;
}

/// The board clears a fault whose cause is gone, and latches it again if it is not.
int clear_fault(const DeviceOptions& options) {
  constexpr std::uint32_t patience_periods = protocol::servo_rate_Hz / 5;
  const auto connection = connect(options);
  device::Device& device = *connection.device;
  PoseReport pose = next_pose(device);
  const bool was_fault = pose.state == State::fault;
  device.send(protocol::Command::clear_fault);
  const std::uint32_t begin_periods = pose.time_periods;
  while (was_fault && pose.time_periods - begin_periods < patience_periods) pose = next_pose(device);
  if (pose.state == State::fault)
    throw device::Error(fmt::format("The fault is there again. {}", device::fault_line(pose.fault)));
  tell_fault(options, pose);
  return 0;
}

}  // namespace

void add_fault_command(const Place& place) {
  auto* command = place.program.add_subcommand("fault", "The fault with its cause and remedy; or `clear`");
  command->require_subcommand(0, 1);
  add_examples(*command, "inkwell fault\ninkwell fault clear");
  command->callback([place, command] {
    if (command->get_subcommands().empty()) place.action = [&options = place.device] { return show_fault(options); };
  });
  auto* cleared = command->add_subcommand("clear", "Clears it once its cause is gone; the force stays off");
  add_examples(*cleared, "inkwell fault clear");
  cleared->callback([place] { place.action = [&options = place.device] { return clear_fault(options); }; });
}

}  // namespace inkwell::command_line
