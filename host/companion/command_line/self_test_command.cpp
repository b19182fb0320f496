#include "host/companion/command_line/commands.hpp"

#include <memory>
#include <string>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "host/client/command_line/help.hpp"
#include "protocol/self_test.hpp"

namespace inkwell::command_line {
namespace {

using nlohmann::ordered_json;
using protocol::SelfTestItem;
using protocol::SelfTestReport;
using protocol::SelfTestResult;

template <class Action>
void for_each_item(const SelfTestReport& report, Action action) {
  for (std::size_t i = 0; i < protocol::self_test_item_count; ++i)
    action(info(static_cast<SelfTestItem>(i)), report.entries[i]);
}

/// Returns true if no item has failed, no test was aborted, and no motor is missing or unknown.
bool is_well(const SelfTestReport& report) {
  bool is_well = true;
  for_each_item(report, [&](const auto&, const auto& entry) {
    is_well &= entry.result == SelfTestResult::passed || entry.result == SelfTestResult::not_done ||
               entry.result == SelfTestResult::no_part;
  });
  return is_well;
}

ordered_json to_json(const SelfTestReport& report) {
  ordered_json items = ordered_json::array();
  for_each_item(report, [&](const auto& item, const auto& entry) {
    items.push_back({{"item", item.name},
                     {"result", info(entry.result).name},
                     {"figure", item.unit.empty() ? ordered_json(nullptr) : ordered_json(entry.figure)},
                     {"unit", item.unit},
                     {"takes_force", item.takes_force},
                     {"meaning", item.meaning},
                     {"remedy", protocol::remedy_of(item, entry.result)}});
  });
  return {{"well", is_well(report)}, {"tests_ended", report.tests_ended}, {"items", items}};
}

void print(const SelfTestReport& report) {
  const auto figure = [](const auto& item, const auto& entry) {
    const bool has_one = !item.unit.empty() && entry.figure != 0.0f;
    return has_one ? fmt::format("{:.3g} {}", entry.figure, item.unit) : std::string();
  };
  for_each_item(report, [&](const auto& item, const auto& entry) {
    fmt::print("{}\n", fmt::format("{:18}  {:10}  {}", item.name, info(entry.result).name, figure(item, entry)));
  });
  for_each_item(report, [&](const auto& item, const auto& entry) {
    if (protocol::is_failure(entry.result))
      fmt::print(
          "\n"
          "{} failed{}. Expected: {} {}\n",
          item.name, item.takes_force ? ", and the force stays off" : "", item.meaning,
          protocol::remedy_of(item, entry.result));
  });
  if (is_well(report)) return;
  bool is_printed[protocol::self_test_result_table.size()] = {};
  for_each_item(report, [&](const auto&, const auto& entry) {
    const auto result = static_cast<std::size_t>(entry.result);
    if (result >= std::size(is_printed) || is_printed[result]) return;
    is_printed[result] = true;
    if (entry.result == SelfTestResult::moved || entry.result == SelfTestResult::broken_off ||
        protocol::awaits_motor(entry.result))
      fmt::print("\n{}: {}\n", info(entry.result).name, info(entry.result).meaning);
  });
  if (protocol::awaits_motors(report))
    fmt::print("\nThe motors receive no current for the force until all motors are present and confirmed.\n");
}

int test(const DeviceOptions& options, bool only_last) {
  const auto connection = connect(options);
  device::Device& device = *connection.device;
  const SelfTestReport report = only_last ? device.read_self_test() : device.self_test();
  if (options.json)
    fmt::print("{}\n", to_json(report).dump(2));
  else
    print(report);
  return is_well(report) ? 0 : 1;
}

}  // namespace

void add_self_test_command(const CommandContext& context) {
  auto* command = context.program.add_subcommand(
      "self-test", "Tests motors, bridges, sensors and wires; shows result, figure and remedy of each item");
  const auto only_last = std::make_shared<bool>(false);
  command->add_flag("--last", *only_last, "Show the results of the last test, without a new test");
  add_examples(*command, "inkwell self-test\ninkwell self-test --last\ninkwell self-test --json");
  command->callback([context, only_last] {
    context.action = [&options = context.device, only_last] { return test(options, *only_last); };
  });
}

}  // namespace inkwell::command_line
