#include "host/companion/command_line/commands.hpp"

#include <memory>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "host/client/command_line/help.hpp"
#include "host/client/command_line/interrupt.hpp"
#include "host/client/local/output.hpp"
#include "protocol/faults.hpp"
#include "protocol/reports.hpp"

#include "host/companion/command_line/force_switch.hpp"
#include "host/companion/command_line/next_pose.hpp"

namespace inkwell::command_line {
namespace {

using device::Pose;
using protocol::State;

void print_force(const DeviceOptions& options, const Pose& pose) {
  if (options.json)
    fmt::print("{}\n", nlohmann::ordered_json{{"force_is_on", protocol::force_is_on(pose.state)},
                                              {"state", info(pose.state).name}}
                           .dump());
  else
    fmt::print("{}\n", force_sentence(pose));
}

int show_force(const DeviceOptions& options) {
  const auto connection = connect(options);
  print_force(options, next_pose(*connection.device));
  return 0;
}

int switch_off(const DeviceOptions& options) {
  const auto connection = connect(options);
  print_force(options, switch_force_off(*connection.device));
  return 0;
}

/// Keeps the force on for `seconds`. If `seconds` is 0, the force stays on until SIGINT. Without signs of life, the
/// board would switch the force off.
int keep_on(const DeviceOptions& options, double seconds) {
  const auto connection = connect(options, BoardPace::real_time);
  device::Device& device = *connection.device;
  const InterruptGuard interrupt;
  ForceSwitch force(device);
  Pose pose = next_pose(device);
  print_force(options, pose);
  if (!options.json && seconds == 0) fmt::print("Ctrl-C switches the force off.\n");
  local::flush_output();
  const std::int64_t begin_periods = pose.time_periods;
  const auto is_over = [&] {
    return seconds > 0 && device::board_time_s(pose.time_periods - begin_periods) >= seconds;
  };
  auto loss = force.loss(pose);
  while (!loss && !is_over() && !interrupt.is_interrupted()) {
    device.keep_alive();
    pose = next_pose(device);
    loss = force.loss(pose);
  }
  if (loss) throw device::Error(*loss);
  print_force(options, force.switch_off());
  return 0;
}

}  // namespace

void add_force_command(const CommandContext& context) {
  auto* command = context.program.add_subcommand("force", "Shows whether the force is on, or switches it on or off");
  command->require_subcommand(0, 1);
  add_examples(*command, "inkwell force\ninkwell force on\ninkwell force off");
  command->callback([context, command] {
    if (command->get_subcommands().empty())
      context.action = [&options = context.device] { return show_force(options); };
  });
  auto* on = command->add_subcommand("on", "Switches the force on until Ctrl-C; walls then push back");
  const auto seconds = std::make_shared<double>(0);
  on->add_option("--seconds", *seconds, "Switch the force off after this board time")
      ->type_name("SECONDS")
      ->check(more_than_zero());
  add_examples(*on, "inkwell force on\ninkwell force on --seconds 10");
  on->callback([context, seconds] {
    context.action = [&options = context.device, seconds] { return keep_on(options, *seconds); };
  });
  auto* off = command->add_subcommand("off", "Switches the force off, whichever program switched it on");
  add_examples(*off, "inkwell force off");
  off->callback([context] { context.action = [&options = context.device] { return switch_off(options); }; });
}

}  // namespace inkwell::command_line
