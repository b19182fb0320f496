// Shows and changes the names of arms.
#include "host/companion/command_line/commands.hpp"

#include <algorithm>
#include <cctype>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "host/client/command_line/help.hpp"
#include "host/client/device/arm_names.hpp"
#include "host/client/local/output.hpp"

namespace inkwell::command_line {
namespace {

using device::NamedArm;

/// Returns "connected", "not connected", or "not checked" for an address that is not on USB.
std::string connection_state(const NamedArm& arm, const std::vector<device::Endpoint>& on_usb) {
  if (device::parse_address(arm.address).kind != device::Address::Kind::usb) return "not checked";
  const bool is_connected =
      std::ranges::any_of(on_usb, [&](const auto& endpoint) { return endpoint.serial_number == arm.address; });
  return is_connected ? "connected" : "not connected";
}

int list_arms(const DeviceOptions& options) {
  const auto arms = device::read_arm_names();
  const auto on_usb = device::find_usb_devices();
  auto json = nlohmann::ordered_json::array();
  for (const auto& arm : arms) {
    const std::string state = connection_state(arm, on_usb);
    json.push_back({{"name", arm.name}, {"address", arm.address}, {"control", arm.control}, {"connection", state}});
    if (!options.json) fmt::print("{:<32} {:<26} {}\n", arm.name, arm.address, state);
  }
  if (options.json)
    fmt::print("{}\n", json.dump(2));
  else if (arms.empty())
    fmt::print("No arm has a name. Bind a name with `inkwell arms bind NAME`.\n");
  return 0;
}

/// Returns a valid address. An empty text is the address of the only arm on USB.
std::string checked_address(const std::string& text) {
  if (text.empty()) return device::address_of(device::find_arm({}));
  const auto address = device::parse_address(text);
  const bool is_number = std::ranges::all_of(text, [](unsigned char c) { return std::isxdigit(c) != 0; });
  if (address.kind == device::Address::Kind::usb && !is_number && device::find_arms(address).empty())
    throw UsageError(fmt::format("`{}` is not an address. Give a serial number or usbip:HOST:PORT.", text));
  return text;
}

struct NewName {
  NamedArm arm;
  bool replaces = false;
};

int bind_name(const NewName& given) {
  auto arm = given.arm;
  try {
    device::check_arm_name(arm.name);
    if (!arm.control.empty()) device::parse_socket(arm.control);
    arm.address = checked_address(arm.address);
  } catch (const device::NoDevice&) {
    throw;
  } catch (const device::Error& error) {
    throw UsageError(error.what());
  }
  const auto file = device::arm_names_file();
  auto arms = device::read_arm_names(file);
  const auto* const before = device::find_arm_name(arms, arm.name);
  if (before != nullptr && !given.replaces)
    throw device::Error(fmt::format("The name {} is already bound to {}. Add --replace, or choose another name.",
                                    before->name, before->address));
  if (before != nullptr)
    arms[static_cast<std::size_t>(before - arms.data())] = arm;
  else
    arms.push_back(arm);
  device::write_arm_names(arms, file);
  fmt::print("The arm {} now has the name {}, in {}.\n", arm.address, arm.name, file.string());
  return 0;
}

int unbind_name(const std::string& name) {
  const auto file = device::arm_names_file();
  auto arms = device::read_arm_names(file);
  const auto* const found = device::find_arm_name(arms, name);
  if (found == nullptr)
    throw device::Error(fmt::format("There is no arm with the name {}. {}", name,
                                    arms.empty() ? "No names are known." : "Known names: " + names_of(arms) + "."));
  arms.erase(arms.begin() + (found - arms.data()));
  device::write_arm_names(arms, file);
  fmt::print("The name {} is removed from {}.\n", name, file.string());
  return 0;
}

}  // namespace

void add_arms_command(const CommandContext& context) {
  auto* command = context.program.add_subcommand(
      "arms",
      "Lists the names of arms, or runs a subcommand\n"
      "Programs for two hands open their arms by name, such as \"left\". The names are in inkwell/arms.toml of\n"
      "$XDG_CONFIG_HOME (~/.config), or in the file that INKWELL_ARMS names. Its order is the order of the arms.");
  command->require_subcommand(0, 1);
  command->callback([context, command] {
    if (command->get_subcommands().empty()) context.action = [&options = context.device] { return list_arms(options); };
  });
  add_examples(*command, "inkwell arms\ninkwell arms bind left\ninkwell run --arms left,right ./two-handed");

  const auto given = std::make_shared<NewName>();
  auto* bind = command->add_subcommand("bind", "Binds a name to an arm");
  bind->add_option("NAME", given->arm.name, "Name, such as left; upper and lower case are equal")->required();
  bind->add_option("ADDRESS", given->arm.address, "Serial number or usbip:HOST:PORT. Default: the only arm on USB");
  bind->add_option("--control-socket", given->arm.control,
                   "HOST:PORT or unix:PATH of a virtual board's control socket, for its simulated hand")
      ->type_name("ADDRESS");
  bind->add_flag("--replace", given->replaces, "Replace the arm of a known name");
  add_examples(*bind, "inkwell arms bind left\ninkwell arms bind right 2F0031000A51373038353635 --replace");
  bind->callback([context, given] { context.action = [given] { return bind_name(*given); }; });

  const auto name = std::make_shared<std::string>();
  auto* unbind = command->add_subcommand("unbind", "Removes a name");
  unbind->add_option("NAME", *name, "Name, such as left")->required();
  add_examples(*unbind, "inkwell arms unbind left");
  unbind->callback([context, name] { context.action = [name] { return unbind_name(*name); }; });
}

}  // namespace inkwell::command_line
