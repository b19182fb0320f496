#include "store_commands.hpp"

#include <unistd.h>

#include <algorithm>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <device/board_store.hpp>
#include <device/parameter_file.hpp>

#include "help.hpp"

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
  const std::size_t told = std::min<std::size_t>(report.unknown, protocol::store_unknown_ids_maximum);
  return {report.unknown_ids, report.unknown_ids + told};
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
  fmt::print("at the start   {} parameters, which firmware {} had stored\n", report.entries, firmware_version(report));
  if (report.out_of_range > 0)
    fmt::print("               {} of them took their default: this firmware refuses their value\n",
               report.out_of_range);
  if (report.unknown > 0)
    fmt::print("               {} of them this firmware does not know but keeps: {}{}\n", report.unknown,
               fmt::join(unknown_ids(report), ", "),
               report.unknown > protocol::store_unknown_ids_maximum ? ", ..." : "");
}

void print(const ParameterSet& held, const BoardStore& store) {
  const StoreReport& report = store.report;
  const auto waiting = not_stored(held, store);
  fmt::print("stored         {}\n", info(report.contents).meaning);
  print_start(report);
  fmt::print("room           {} more before the board's next start, which makes some\n", report.stores_left);
  fmt::print("wear           {} written, sectors erased {} times\n", report.records_written,
             fmt::join(report.sector_erases, " and "));
  if (waiting.empty()) {
    fmt::print("\nThe next start gives every parameter the value that it has now.\n");
    return;
  }
  fmt::print("\nLost with the board's power, unless `inkwell parameters store` keeps them:\n");
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

void tell(const DeviceOptions& options, device::Device& device, std::string_view done) {
  if (options.json)
    fmt::print("{}\n", to_json(device.parameters(), read_store(device)).dump(2));
  else
    fmt::print("{}\n", done);
  tell_what_ends(options, true);
}

int store(const DeviceOptions& options) {
  const auto connection = connect(options);
  store_parameters(*connection.device);
  tell(options, *connection.device, "The parameters are stored on the board and outlive its power.");
  return 0;
}

int restore(const DeviceOptions& options) {
  const auto connection = connect(options);
  connection.device->restore_stored_parameters();
  tell(options, *connection.device, "Every parameter has the value that is stored on the board.");
  return 0;
}

bool agrees() {
  fmt::print(stderr,
             "Everything that is stored on the board is forgotten, the calibration of its arm too. `inkwell parameters "
             "save FILE` keeps it in a file.\n");
  if (isatty(STDIN_FILENO) != 1)
    throw UsageError("A factory reset needs your consent, but nothing can be typed here. Give --yes to agree.");
  fmt::print(stderr, "Type yes to go on: ");
  std::fflush(stderr);
  std::string line;
  std::getline(std::cin, line);
  return line == "yes" || line == "y";
}

int reset(const DeviceOptions& options, bool is_agreed) {
  if (!is_agreed && !agrees()) throw device::Error("Nothing was forgotten.");
  const auto connection = connect(options);
  factory_reset(*connection.device);
  tell(options, *connection.device, "What was stored is forgotten, and every parameter has its default.");
  return 0;
}

}  // namespace

void tell_what_ends(const DeviceOptions& options, bool is_stored) {
  if (!options.is_virtual || (is_stored && !options.flash.empty())) return;
  if (is_stored)
    fmt::print(stderr, "inkwell: This virtual board ends now, with its flash. With --flash FILE it keeps it.\n");
  else if (options.flash.empty())
    fmt::print(
        stderr,
        "inkwell: This virtual board ends now, with these values. With --flash FILE and --store they are kept.\n");
  else
    fmt::print(stderr,
               "inkwell: This virtual board ends now, and {} keeps only what is stored. Add --store to keep these "
               "values.\n",
               options.flash.string());
}

void add_store_commands(CLI::App& parameters, const Place& place) {
  const auto add = [&](const char* name, const char* help, std::function<int()> run) {
    auto* command = parameters.add_subcommand(name, help);
    command->callback([place, run] { place.action = run; });
    return command;
  };
  const DeviceOptions& options = place.device;
  add_examples(*add("store", "Keep the parameters on the board as they are now, over its power",
                    [&options] { return store(options); }),
               "inkwell parameters store\ninkwell parameters store --json");
  add_examples(*add("restore", "Give every parameter the value that is stored on the board",
                    [&options] { return restore(options); }),
               "inkwell parameters restore");
  add_examples(*add("stored", "What the board has stored, what would be lost with its power, and the flash's wear",
                    [&options] { return show(options); }),
               "inkwell parameters stored\ninkwell parameters stored --json");
  const auto yes = std::make_shared<bool>(false);
  auto* factory = add("factory", "Forget what is stored, the calibration too; every parameter gets its default",
                      [&options, yes] { return reset(options, *yes); });
  factory->add_flag("--yes", *yes, "Agree beforehand");
  add_examples(*factory, "inkwell parameters factory\ninkwell parameters factory --yes");
}

}  // namespace inkwell::command_line
