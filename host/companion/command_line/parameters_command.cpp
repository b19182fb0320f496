#include "host/companion/command_line/commands.hpp"

#include <filesystem>
#include <memory>
#include <system_error>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "host/client/command_line/help.hpp"
#include "host/client/device/board_store.hpp"
#include "host/client/device/parameter_file.hpp"
#include "host/client/local/output.hpp"

#include "host/companion/command_line/store_commands.hpp"

namespace inkwell::command_line {
namespace {

using device::format_value;
using device::ParameterChange;
using nlohmann::ordered_json;
using protocol::Parameter;
using protocol::ParameterSet;

ordered_json to_json(Parameter parameter, float value, float stored) {
  const auto& row = info(parameter);
  return {{"id", row.id},       {"name", row.name}, {"value", value},         {"default", row.default_value},
          {"stored", stored},   {"unit", row.unit}, {"minimum", row.minimum}, {"maximum", row.maximum},
          {"group", row.group}, {"help", row.help}};
}

void explain_marks(std::size_t not_stored) {
  fmt::print("\n* differs from the default of this companion\n");
  if (not_stored == 0)
    fmt::print("After the next start, the board has the same parameter values.\n");
  else
    fmt::print("! {} {} not stored and lost at power loss, unless you store {} with `inkwell parameters store`\n",
               not_stored, not_stored == 1 ? "value is" : "values are", not_stored == 1 ? "it" : "them");
}

int list(const DeviceOptions& options) {
  const auto connection = connect(options);
  const ParameterSet held = connection.device->parameters();
  const device::BoardStore store = read_store(*connection.device);
  ordered_json json = ordered_json::array();
  std::string_view group;
  for (std::size_t i = 0; i < protocol::known_parameters().size(); ++i) {
    const auto parameter = static_cast<Parameter>(i);
    const auto& row = info(parameter);
    if (options.json) {
      json.push_back(to_json(parameter, held.values[i], store.at_next_start.values[i]));
      continue;
    }
    if (row.group != group)
      fmt::print("{}{:<34} {:>14}    {:>12}   {:<24} {}\n", group.empty() ? "" : "\n", row.group, "value", "default",
                 "range", "unit");
    group = row.group;
    const std::string range =
        fmt::format("{} to {}", format_value(parameter, row.minimum), format_value(parameter, row.maximum));
    fmt::print("  {:<32} {:>14} {}{} {:>12}   {:<24} {}\n", row.name, format_value(parameter, held.values[i]),
               held.values[i] == row.default_value ? ' ' : '*',
               held.values[i] == store.at_next_start.values[i] ? ' ' : '!', format_value(parameter, row.default_value),
               range, row.unit);
  }
  if (options.json)
    fmt::print("{}\n", json.dump(2));
  else
    explain_marks(not_stored(held, store).size());
  return 0;
}

template <class Read>
auto read_words(const DeviceOptions& options, const std::vector<std::string>& words, Read read) {
  auto typed = read_typed(options, [&] {
    std::vector<decltype(read(std::string_view()))> results;
    for (const auto& word : words) results.push_back(read(word));
    return results;
  });
  if (!typed.connection) typed.connection = connect(options);
  return typed;
}

int get(const DeviceOptions& options, const std::vector<std::string>& names) {
  const auto [parameters, connection] = read_words(options, names, device::parameter_named);
  const ParameterSet held = connection->device->parameters();
  ordered_json json = ordered_json::object();
  for (auto parameter : parameters) {
    if (options.json)
      json[std::string(info(parameter).name)] = held[parameter];
    else
      fmt::print("{}\n", format_value(parameter, held[parameter]));
  }
  if (options.json) fmt::print("{}\n", json.dump());
  return 0;
}

void finish(const DeviceOptions& options, device::Device& device, std::size_t count,
            const device::AcceptedTransaction& transaction, bool store) {
  if (store) store_parameters(device);
  if (options.json) {
    ordered_json json{{"accepted", count}, {"applied_at_periods", transaction.applied_at_periods}};
    if (store) json["stored"] = true;
    fmt::print("{}\n", json.dump());
  } else {
    fmt::print("{} parameter{} took effect together.\n", count, count == 1 ? "" : "s");
    if (store) fmt::print("The parameters are stored on the board and survive power loss.\n");
  }
  print_unstored(options, store);
}

int send(const DeviceOptions& options, const device::OpenArm& connection, const std::vector<ParameterChange>& changes,
         bool store) {
  finish(options, *connection.device, changes.size(), connection.device->set_parameters(changes), store);
  return 0;
}

int set(const DeviceOptions& options, const std::vector<std::string>& assignments, bool store) {
  const auto [changes, connection] = read_words(options, assignments, device::parse_change);
  return send(options, *connection, changes, store);
}

int restore_defaults(const DeviceOptions& options, bool store) {
  const auto connection = connect(options);
  finish(options, *connection.device, protocol::known_parameters().size(),
         connection.device->restore_default_parameters(), store);
  return 0;
}

/// Loads a file and reports unknown names. Opens the device first if necessary, because the device's force law may
/// define more names.
Typed<device::ParameterFile> load_and_complain(const DeviceOptions& options, const std::string& file) {
  std::optional<device::OpenArm> connection;
  auto loaded = device::load_parameters(file);
  if (!loaded.unknown.empty()) {
    connection = connect(options);
    loaded = device::load_parameters(file);
  }
  for (const auto& name : loaded.unknown)
    local::print_error("inkwell: {} is not a parameter of this version and is ignored.{}\n", name,
                       device::parameter_suggestion(name));
  if (loaded.changes.empty())
    throw device::Error(fmt::format("{} contains no parameter of this version. Nothing was sent.", file));
  if (!connection) connection = connect(options);
  return {std::move(loaded), std::move(connection)};
}

/// Throws UsageError if the file exists, because the file may be the only copy of a calibration.
void check_is_free(const std::string& file) {
  std::error_code code;
  if (std::filesystem::is_directory(file, code))
    throw UsageError(fmt::format("{} is a folder. Give the name of a file in it.", file));
  if (std::filesystem::exists(file, code))
    throw UsageError(
        fmt::format("{} already exists. Give another name, or add --overwrite to replace the file.", file));
}

int save(const DeviceOptions& options, const std::string& file, bool overwrite) {
  const bool is_standard_output = file == "-";
  if (!is_standard_output && !overwrite) check_is_free(file);
  const auto connection = connect(options);
  const auto parameters = connection.device->parameters();
  const auto origin = device::origin_of(connection.device->information());
  if (is_standard_output) {
    fmt::print("{}", device::format_parameters(parameters, origin));
    return 0;
  }
  device::save_parameters(file, parameters, origin);
  if (options.json)
    fmt::print("{}\n", ordered_json{{"file", file}, {"parameters", protocol::known_parameters().size()}}.dump());
  else
    fmt::print("{} parameters were written to {}.\n", protocol::known_parameters().size(), file);
  return 0;
}

/// Asks before values that belong to one arm are overwritten.
void ask_for_arm(const device::ParameterFile& loaded, device::Device& device, const std::string& file) {
  const auto differences = compare_arm(loaded, device.parameters());
  if (differences.empty()) return;
  std::string consequence = fmt::format("{} changes the arm's geometry, directions, motors or calibration. {}", file,
                                        origin_text(loaded.origin, origin_of(device.information())));
  for (const auto& difference : differences) consequence += "\n  " + difference_text(difference);
  if (!agrees(consequence, "This change of the arm")) throw device::Error("Nothing was sent.");
}

int load(const DeviceOptions& options, const std::string& file, bool store, bool is_agreed) {
  const auto [loaded, connection] = load_and_complain(options, file);
  if (!is_agreed) ask_for_arm(loaded, *connection->device, file);
  return send(options, *connection, loaded.changes, store);
}

int show_differences(const DeviceOptions& options, const std::string& file) {
  const auto [loaded, connection] = load_and_complain(options, file);
  const auto differences = compare(loaded, connection->device->parameters());
  ordered_json json = ordered_json::array();
  for (const auto& difference : differences) {
    const auto& row = info(difference.parameter);
    if (options.json)
      json.push_back({{"name", row.name}, {"file", difference.in_file}, {"device", difference.in_device}});
    else
      fmt::print("{}\n", difference_text(difference));
  }
  if (options.json)
    fmt::print("{}\n", json.dump(2));
  else if (differences.empty())
    fmt::print("The device has the same values as {}.\n", file);
  return 0;
}

/// Adds subcommands to `inkwell parameters`. Subcommands that change parameters have the flag --store.
struct Subcommands {
  CLI::App& command;
  const CommandContext& context;
  std::shared_ptr<bool> store = std::make_shared<bool>(false);

  CLI::App* add(const char* name, const char* help, const char* examples, std::function<int()> run) const {
    auto* subcommand = command.add_subcommand(name, help);
    add_examples(*subcommand, examples);
    subcommand->callback([context = context, run] { context.action = run; });
    return subcommand;
  }
  CLI::App* add_change(const char* name, const char* help, const char* examples, std::function<int()> run) const {
    auto* subcommand = add(name, help, examples, std::move(run));
    subcommand->add_flag("--store", *store, "Also store the parameters on the board, so that they survive power loss");
    return subcommand;
  }
};

void add_get_and_set(const Subcommands& subcommands, const DeviceOptions& options) {
  const auto words = std::make_shared<std::vector<std::string>>();
  subcommands
      .add("get", "Prints the values of one or more parameters",
           "inkwell parameters get wall_stiffness_N_per_m box_maximum_z_m",
           [&options, words] { return get(options, *words); })
      ->add_option("NAME", *words, "Parameter names")
      ->required();
  subcommands
      .add_change("set", "Changes parameters in one transaction: all of them take effect together, or none",
                  "inkwell parameters set wall_stiffness_N_per_m=600 wall_damping_Ns_per_m=3\n"
                  "inkwell parameters set wall_stiffness_N_per_m=600 --store",
                  [&options, words, store = subcommands.store] { return set(options, *words, *store); })
      ->add_option("ASSIGNMENT", *words,
                   "NAME=VALUE: a parameter and its new value, in the unit at the end of its name")
      ->required();
  subcommands.add_change("defaults", "Sets every parameter to its default", "inkwell parameters defaults",
                         [&options, store = subcommands.store] { return restore_defaults(options, *store); });
}

void add_file_commands(const Subcommands& subcommands, const DeviceOptions& options) {
  const auto file = std::make_shared<std::string>();
  const auto yes = std::make_shared<bool>(false);
  auto* load_command = subcommands.add_change(
      "load", "Sends the parameters of a TOML file in one transaction", "inkwell parameters load soft.toml",
      [&options, file, yes, store = subcommands.store] { return load(options, *file, *store, *yes); });
  load_command->add_option("FILE", *file, "File written by `inkwell parameters save`")->required();
  load_command->add_flag("--yes", *yes,
                         "Agree in advance to change the arm's geometry, directions, motors and calibration");
  const auto overwrite = std::make_shared<bool>(false);
  auto* save_command =
      subcommands.add("save", "Writes the device's parameters to a TOML file",
                      "inkwell parameters save soft.toml\ninkwell parameters save soft.toml --overwrite",
                      [&options, file, overwrite] { return save(options, *file, *overwrite); });
  save_command->add_option("FILE", *file, "New file to write; - is standard output")->required();
  save_command->add_flag("--overwrite", *overwrite, "Replace an existing file");
  subcommands
      .add("diff", "Shows the differences between a TOML file and the device", "inkwell parameters diff soft.toml",
           [&options, file] { return show_differences(options, *file); })
      ->add_option("FILE", *file, "File written by `inkwell parameters save`")
      ->required();
  subcommands
      .add_change("arm", "Sends the geometry, limits and box of an arm description in one transaction",
                  "inkwell parameters arm boards/arms/paper.toml",
                  [&options, file, store = subcommands.store] {
                    return send(options, connect(options), device::arm_parameters(*file), *store);
                  })
      ->add_option("FILE", *file, "Arm description, such as boards/arms/paper.toml")
      ->required();
}

}  // namespace

void add_parameters_command(const CommandContext& context) {
  auto* command =
      context.program.add_subcommand("parameters",
                                     "Lists all parameters with value, default, range and unit, or runs a subcommand\n"
                                     "Changed values are lost when the board loses power. To store them on the board, "
                                     "use `inkwell parameters store`,\n"
                                     "or add --store to the command that changes them.");
  command->require_subcommand(0, 1);
  const DeviceOptions& options = context.device;
  command->callback([context, command] {
    if (command->get_subcommands().empty()) context.action = [&options = context.device] { return list(options); };
  });

  add_examples(*command,
               "inkwell parameters\n"
               "inkwell parameters set wall_stiffness_N_per_m=600 wall_damping_Ns_per_m=3\n"
               "inkwell parameters save soft.toml\n"
               "inkwell parameters store");

  const Subcommands subcommands{*command, context};
  add_get_and_set(subcommands, options);
  add_file_commands(subcommands, options);
  add_store_commands(*command, context);
}

}  // namespace inkwell::command_line
