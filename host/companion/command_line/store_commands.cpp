#include "host/companion/command_line/store_commands.hpp"

#include <unistd.h>

#include <algorithm>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "host/client/command_line/help.hpp"
#include "host/client/device/board_store.hpp"
#include "host/client/device/parameter_file.hpp"
#include "host/client/local/output.hpp"

namespace inkwell::command_line {
namespace {

using device::BoardStore;
using device::format_value;
using nlohmann::ordered_json;
using protocol::ParameterSet;
using protocol::StoreContents;
using protocol::StoreReport;

std::string firmware_version(const StoreReport& report) {
  const auto& version = report.firmware_version;
  return fmt::format("{}.{}.{}", version[0], version[1], version[2]);
}

std::vector<std::uint16_t> unknown_ids(const StoreReport& report) {
  const std::size_t listed = std::min<std::size_t>(report.unknown, protocol::store_unknown_ids_maximum);
  return {report.unknown_ids, report.unknown_ids + listed};
}

ordered_json to_json(const ParameterSet& held, const BoardStore& store) {
  const StoreReport& report = store.report;
  ordered_json waiting = ordered_json::array();
  for (const auto parameter : not_stored(held, store))
    waiting.push_back({{"name", info(parameter).name},
                       {"value", held[parameter]},
                       {"stored", store.at_next_start[parameter]},
                       {"unit", info(parameter).unit}});
  ordered_json at_start{{"contents", info(report.contents_at_start).name}};
  if (report.schema != 0)
    at_start.update({{"firmware_version", firmware_version(report)},
                     {"schema", report.schema},
                     {"parameters", report.entries},
                     {"out_of_range", report.out_of_range},
                     {"unknown", report.unknown},
                     {"unknown_ids", unknown_ids(report)}});
  return {{"contents", info(report.contents).name},
          {"not_stored", waiting},
          {"stores_left", report.stores_left},
          {"records_written", report.records_written},
          {"sector_erases", report.sector_erases},
          {"last_result", info(report.result).name},
          {"at_start", at_start}};
}

void print_start(const StoreReport& report) {
  if (report.contents_at_start != StoreContents::parameters) return;
  fmt::print("at the start   {} parameters, stored by firmware {}\n", report.entries, firmware_version(report));
  if (report.out_of_range > 0)
    fmt::print("               {} parameters have their default: this firmware rejects the stored values\n",
               report.out_of_range);
  if (report.unknown > 0)
    fmt::print("               {} parameters are unknown to this firmware but retained: {}{}\n", report.unknown,
               fmt::join(unknown_ids(report), ", "),
               report.unknown > protocol::store_unknown_ids_maximum ? ", ..." : "");
}

void print(const ParameterSet& held, const BoardStore& store) {
  const StoreReport& report = store.report;
  const auto waiting = not_stored(held, store);
  fmt::print("stored         {}\n", info(report.contents).meaning);
  print_start(report);
  fmt::print("room           {} more stores; the next start of the board frees space\n", report.stores_left);
  fmt::print("wear           {} records written, sectors erased {} times\n", report.records_written,
             fmt::join(report.sector_erases, " and "));
  if (waiting.empty()) {
    fmt::print(
        "\n"
        "After the next start, the board has the same parameter values.\n");
    return;
  }
  fmt::print(
      "\n"
      "These values are lost at power loss, unless you store them with `inkwell parameters store`:\n");
  for (const auto parameter : waiting)
    fmt::print("  {:<32} {:>12}   stored {:>12} {}\n", info(parameter).name, format_value(parameter, held[parameter]),
               format_value(parameter, store.at_next_start[parameter]), info(parameter).unit);
}

int show(const DeviceOptions& options) {
  const auto connection = connect(options);
  const ParameterSet held = connection.device->parameters();
  const BoardStore store = read_store(*connection.device);
  if (options.json)
    fmt::print("{}\n", to_json(held, store).dump(2));
  else
    print(held, store);
  return 0;
}

void print_result(const DeviceOptions& options, device::Device& device, std::string_view done) {
  if (options.json)
    fmt::print("{}\n", to_json(device.parameters(), read_store(device)).dump(2));
  else
    fmt::print("{}\n", done);
  print_unstored(options, true);
}

int store(const DeviceOptions& options) {
  const auto connection = connect(options);
  store_parameters(*connection.device);
  print_result(options, *connection.device, "The parameters are stored on the board and survive power loss.");
  return 0;
}

int restore(const DeviceOptions& options) {
  const auto connection = connect(options);
  connection.device->restore_stored_parameters();
  print_result(options, *connection.device, "Every parameter has its stored value.");
  return 0;
}

int reset(const DeviceOptions& options, bool is_agreed) {
  if (!is_agreed &&
      !agrees("This erases all stored parameters, including the calibration of the arm. To save them to a file first, "
              "use `inkwell parameters save FILE`.",
              "A factory reset"))
    throw device::Error("Nothing was erased.");
  const auto connection = connect(options);
  factory_reset(*connection.device);
  print_result(options, *connection.device, "The stored parameters are erased, and every parameter has its default.");
  return 0;
}

}  // namespace

bool agrees(std::string_view consequence, std::string_view action) {
  local::print_error("{}\n", consequence);
  if (isatty(STDIN_FILENO) != 1)
    throw UsageError(
        fmt::format("{} needs your consent, but standard input is not a terminal. Add --yes to agree.", action));
  local::print_error("Type yes to continue: ");
  std::string line;
  std::getline(std::cin, line);
  return line == "yes" || line == "y";
}

void print_unstored(const DeviceOptions& options, bool is_stored) {
  if (!options.is_virtual || (is_stored && !options.flash.empty())) return;
  if (is_stored)
    local::print_error("inkwell: This virtual board exits now, and its flash is lost. Use --flash FILE to keep it.\n");
  else if (options.flash.empty())
    local::print_error(
        "inkwell: This virtual board exits now, and these values are lost. Use --flash FILE and --store to keep "
        "them.\n");
  else
    local::print_error(
        "inkwell: This virtual board exits now, and {} contains only stored values. Add --store to keep these "
        "values.\n",
        options.flash.string());
}

void add_store_commands(CLI::App& parameters, const CommandContext& context) {
  const auto add = [&](const char* name, const char* help, std::function<int()> run) {
    auto* command = parameters.add_subcommand(name, help);
    command->callback([context, run] { context.action = run; });
    return command;
  };
  const DeviceOptions& options = context.device;
  add_examples(*add("store", "Stores the current parameters on the board, so that they survive power loss",
                    [&options] { return store(options); }),
               "inkwell parameters store\ninkwell parameters store --json");
  add_examples(*add("restore", "Sets every parameter to its stored value", [&options] { return restore(options); }),
               "inkwell parameters restore");
  add_examples(*add("stored", "Shows the stored parameters, the values that are not stored, and the flash wear",
                    [&options] { return show(options); }),
               "inkwell parameters stored\ninkwell parameters stored --json");
  const auto yes = std::make_shared<bool>(false);
  auto* factory = add("factory", "Erases the stored parameters and the calibration; restores all defaults",
                      [&options, yes] { return reset(options, *yes); });
  factory->add_flag("--yes", *yes, "Agree in advance");
  add_examples(*factory, "inkwell parameters factory\ninkwell parameters factory --yes");
}

}  // namespace inkwell::command_line
