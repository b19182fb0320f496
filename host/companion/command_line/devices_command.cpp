#include "host/companion/command_line/commands.hpp"

#include <string>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "host/client/command_line/help.hpp"
#include "host/client/device/arm_names.hpp"
#include "host/client/device/device.hpp"
#include "host/client/device/transport.hpp"
#include "host/client/local/output.hpp"

namespace inkwell::command_line {
namespace {

using device::Endpoint;
using nlohmann::ordered_json;

std::vector<Endpoint> found(const DeviceOptions& options) {
  if (options.is_virtual)
    throw UsageError("--virtual starts a board for one command only, so there is no board to list. Omit --virtual.");
  const device::Address address = options.address();
  if (address.kind != device::Address::Kind::usbip) return device::find_usb_devices();
  return {device::find_arm(address)};
}

std::string location_of(const Endpoint& endpoint) {
  return endpoint.kind == Endpoint::Kind::usb ? std::string("USB") : fmt::format("usbip {}", endpoint.server.text());
}

struct Listed {
  std::string serial_number, product, location;
  std::string board;  ///< empty: not reported by the firmware, or the device did not answer
  std::string name;   ///< from `inkwell arms bind`, or empty
};

/// The list includes devices that do not answer. The information request works with every protocol version.
Listed query_arm(const Endpoint& endpoint) {
  Listed listed{endpoint.serial_number, endpoint.product, location_of(endpoint), {}, {}};
  try {
    const auto information = device::Device(device::open_transport(endpoint)).information();
    listed.serial_number = information.serial_number;  // USB/IP device lists do not contain it
    listed.board = information.board_name;
  } catch (const device::Error& error) {
    local::print_error("inkwell: The board name of arm {} cannot be read. {}\n", endpoint.serial_number, error.what());
  }
  return listed;
}

int list_devices(const DeviceOptions& options) {
  const auto devices = found(options);
  const auto names = device::read_arm_names();
  ordered_json json = ordered_json::array();
  for (const Endpoint& endpoint : devices) {
    Listed each = query_arm(endpoint);
    each.name = device::name_of_address(names, device::address_of(endpoint));
    if (options.json)
      json.push_back({{"serial_number", each.serial_number},
                      {"product", each.product},
                      {"board", each.board},
                      {"location", each.location},
                      {"name", each.name}});
    else
      fmt::print("{:<26} {:<28} {:<20} {}{}{}\n", each.serial_number, each.product,
                 each.board.empty() ? "unknown board" : each.board, each.location, each.name.empty() ? "" : "  ",
                 each.name);
  }
  if (options.json)
    fmt::print("{}\n", json.dump(2));
  else if (devices.empty())
    fmt::print("No arm is connected over USB. Connect one, or name a virtual board with --usbip HOST:PORT.\n");
  return 0;
}

}  // namespace

void add_devices_command(const CommandContext& context) {
  auto* command = context.program.add_subcommand("devices", "Lists the connected arms with serial number and board");
  add_examples(*command, "inkwell devices\ninkwell devices --usbip 127.0.0.1:3240 --json");
  command->callback([context] { context.action = [&options = context.device] { return list_devices(options); }; });
}

}  // namespace inkwell::command_line
