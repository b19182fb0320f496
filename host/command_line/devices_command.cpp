#include "commands.hpp"

#include <string>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <device/device.hpp>

#include "help.hpp"

namespace inkwell::command_line {
namespace {

using device::Endpoint;
using nlohmann::ordered_json;

std::vector<Endpoint> found(const DeviceOptions& options) {
  if (options.is_virtual)
    throw UsageError("--virtual starts a board for one command, so that none is there to be listed. Leave it out.");
  const device::Address address = options.address();
  if (address.kind != device::Address::Kind::usbip) return device::find_usb_devices();
  Endpoint endpoint = device::find_arm(address);  // which says its serial number only when it is opened
  endpoint.serial_number = device::Device::open(endpoint)->information().serial_number;
  return {endpoint};
}

std::string place_of(const Endpoint& endpoint) {
  return endpoint.kind == Endpoint::Kind::usb ? std::string("USB")
                                              : fmt::format("usbip {}:{}", endpoint.host, endpoint.port);
}

int list_devices(const DeviceOptions& options) {
  const auto devices = found(options);
  ordered_json json = ordered_json::array();
  for (const Endpoint& each : devices) {
    if (options.json)
      json.push_back({{"serial_number", each.serial_number}, {"product", each.product}, {"place", place_of(each)}});
    else
      fmt::print("{:<26} {:<28} {}\n", each.serial_number, each.product, place_of(each));
  }
  if (options.json)
    fmt::print("{}\n", json.dump(2));
  else if (devices.empty())
    fmt::print("No arm is on USB. Plug one in, or name a virtual board with --usbip HOST:PORT.\n");
  return 0;
}

}  // namespace

void add_devices_command(const Place& place) {
  auto* command = place.program.add_subcommand("devices", "The arms that are there, by serial number");
  add_examples(*command, "inkwell devices\ninkwell devices --usbip 127.0.0.1:3240 --json");
  command->callback([place] { place.action = [&options = place.device] { return list_devices(options); }; });
}

}  // namespace inkwell::command_line
