#include "host/companion/command_line/commands.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "host/client/command_line/help.hpp"
#include "protocol/signals.hpp"

namespace inkwell::command_line {
namespace {

using nlohmann::ordered_json;

int list_signals(const DeviceOptions& options) {
  ordered_json json = ordered_json::array();
  for (const auto& row : protocol::known_signals())
    if (options.json)
      json.push_back({{"name", row.name}, {"unit", row.unit}, {"help", row.help}});
    else
      fmt::print("{:<24} {:<7} {}\n", row.name, row.unit, row.help);
  if (options.json) fmt::print("{}\n", json.dump(2));
  return 0;
}

}  // namespace

void add_signals_command(const CommandContext& context) {
  auto* command =
      context.program.add_subcommand("signals", "Lists all signals that can be recorded, with unit; needs no device");
  add_examples(*command, "inkwell signals");
  command->callback([context] { context.action = [&options = context.device] { return list_signals(options); }; });
}

}  // namespace inkwell::command_line
