#include "host/companion/command_line/commands.hpp"

#include <memory>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "host/client/command_line/help.hpp"
#include "host/client/device/bus_clock.hpp"
#include "host/client/local/output.hpp"
#include "protocol/reports.hpp"

#include "host/companion/command_line/next_pose.hpp"

namespace inkwell::command_line {
namespace {

using device::Pose;

struct WatchOptions {
  double seconds = 0;  ///< 0: until interrupted
  double rate_Hz = 10;
};

std::vector<std::string_view> force_sources(const Pose& pose) {
  std::vector<std::string_view> names;
  for (const auto& row : protocol::force_source_table)
    if (protocol::is_felt(pose.force_sources, row.source)) names.push_back(row.name);
  return names;
}

std::vector<std::string_view> limits(const Pose& pose) {
  std::vector<std::string_view> names;
  for (const auto& row : protocol::limit_table)
    if (protocol::is_reached(pose.limits, row.limit)) names.push_back(row.name);
  return names;
}

std::string force_of(const Pose& pose) {
  if (!protocol::force_is_on(pose.state)) return "-";
  const auto reached = limits(pose);
  return fmt::format("{}{}", fmt::join(force_sources(pose), ", "),
                     reached.empty() ? "" : fmt::format("; limited by {}", fmt::join(reached, ", ")));
}

nlohmann::ordered_json to_json(const Pose& pose, double host_time_s, std::uint64_t lost) {
  return {{"sequence", pose.sequence},
          {"time_s", device::board_time_s(pose.time_periods)},
          {"host_time_s", host_time_s},
          {"state", info(pose.state).name},
          {"fault", info(pose.fault).name},
          {"referenced", pose.is_referenced},
          {"position_m", {pose.position_m[0], pose.position_m[1], pose.position_m[2]}},
          {"gimbal_rad", {pose.gimbal_rad[0], pose.gimbal_rad[1], pose.gimbal_rad[2]}},
          {"force_N", {pose.force_N[0], pose.force_N[1], pose.force_N[2]}},
          {"force_sources", force_sources(pose)},
          {"limits", limits(pose)},
          {"joint_rad", {pose.joint_rad[0], pose.joint_rad[1], pose.joint_rad[2]}},
          {"button_1", is_closed(pose.switches, protocol::Switch::button_1)},
          {"button_2", is_closed(pose.switches, protocol::Switch::button_2)},
          {"inkwell", is_closed(pose.switches, protocol::Switch::inkwell)},
          {"supply_V", pose.supply_dV / 10.0},
          {"lost", lost}};
}

void print_head() {
  fmt::print("{:>9}  {:<12} {:>26}  {:>23}  {:<12} {:>5}  {}\n", "time / s", "state", "position x y z / mm",
             "force x y z / N", "switches", "lost", "force of");
}

std::string position_of(const Pose& pose) {
  if (!pose.is_referenced) return "unknown";
  const auto& p = pose.position_m;
  return fmt::format("{:8.2f} {:8.2f} {:8.2f}", 1e3f * p[0], 1e3f * p[1], 1e3f * p[2]);
}

void print_line(const Pose& pose, std::uint64_t lost) {
  const auto& f = pose.force_N;
  fmt::print("{:9.3f}  {:<12} {:>26}  {:7.2f} {:7.2f} {:7.2f}  {}{}{} {:>6}  {}\n",
             device::board_time_s(pose.time_periods),
             pose.state == protocol::State::fault ? info(pose.fault).name : info(pose.state).name, position_of(pose),
             f[0], f[1], f[2], is_closed(pose.switches, protocol::Switch::button_1) ? "1 " : "- ",
             is_closed(pose.switches, protocol::Switch::button_2) ? "2 " : "- ",
             is_closed(pose.switches, protocol::Switch::inkwell) ? "inkwell" : "-      ", lost, force_of(pose));
}

int watch(const DeviceOptions& options, const WatchOptions& watch_options) {
  const auto connection = connect(options, BoardPace::real_time);
  if (!options.json) print_head();
  const auto information = connection.device->information().report;
  device::BusClock clock(static_cast<double>(information.processor_clock_Hz) / information.servo_rate_Hz);
  std::optional<std::int64_t> first_period, sequence, clock_read_at;
  std::int64_t next_shown = 0;
  std::uint64_t lost = 0;
  const auto periods_shown = static_cast<std::int64_t>(protocol::servo_rate_Hz / watch_options.rate_Hz);
  for (;;) {
    const Pose pose = next_pose(*connection.device);
    if (sequence) lost += static_cast<std::uint64_t>(pose.sequence - *sequence - 1);
    sequence = pose.sequence;
    if (!first_period) first_period = pose.time_periods;
    const std::int64_t passed = pose.time_periods - *first_period;
    if (watch_options.seconds > 0 && device::board_time_s(passed) >= watch_options.seconds) return 0;
    if (!clock_read_at || pose.time_periods - *clock_read_at >= protocol::servo_rate_Hz) {
      if (const auto frame = connection.device->bus_frame()) {
        clock.note(*frame);
        clock_read_at = pose.time_periods;
      }
    }
    if (!clock_read_at) continue;
    if (passed < next_shown) continue;
    next_shown += periods_shown;
    if (options.json)
      fmt::print("{}\n", to_json(pose, *clock.host_time_s(pose.time_periods), lost).dump());
    else
      print_line(pose, lost);
    local::flush_output();
  }
}

}  // namespace

void add_watch_command(const CommandContext& context) {
  auto* command = context.program.add_subcommand(
      "watch", "Prints the live pose: position, force, buttons and state, ten lines per second");
  const auto watch_options = std::make_shared<WatchOptions>();
  command->add_option("--seconds", watch_options->seconds, "Stop after this board time. Default: at Ctrl+C")
      ->type_name("SECONDS")
      ->check(more_than_zero());
  command->add_option("--rate", watch_options->rate_Hz, "Lines per second, 0.1 to 1000")
      ->type_name("HZ")
      ->check(number_within(0.1, 1000.0))
      ->capture_default_str();
  add_examples(*command, "inkwell watch\ninkwell watch --virtual --seconds 2 --rate 100 --json");
  command->callback([context, watch_options] {
    context.action = [&options = context.device, watch_options] { return watch(options, *watch_options); };
  });
}

}  // namespace inkwell::command_line
