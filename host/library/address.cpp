#include <unistd.h>

#include <atomic>
#include <charconv>
#include <cstdlib>
#include <cstring>

#include <fmt/format.h>

#include "arm.hpp"

namespace inkwell::library {
namespace {

constexpr char usbip_scheme[] = "usbip:", virtual_scheme[] = "virtual:", own_board[] = "virtual";

std::string environment_address() {
  const char* address = std::getenv("INKWELL_DEVICE");
  return address == nullptr ? std::string() : std::string(address);
}

device::Endpoint find_usbip(const std::string& address) {
  const auto colon = address.rfind(':');
  std::uint16_t port = 0;
  const char* digits = address.data() + colon + 1;
  const char* end = address.data() + address.size();
  if (colon == std::string::npos || colon == 0 || std::from_chars(digits, end, port).ptr != end || port == 0)
    throw BadArgument(
        fmt::format("`usbip:{}` is no address. Give usbip:HOST:PORT, for example usbip:127.0.0.1:3240.", address));
  const auto endpoints = device::find_usbip_devices(address.substr(0, colon), port);
  if (endpoints.empty())
    throw NoDevice(
        fmt::format("The USB/IP server at {} exports no arm. Check that its board runs Inkwell's firmware "
                    "and its cable is in.",
                    address));
  return endpoints.front();
}

device::Endpoint find_usb(const std::string& serial_number) {
  auto endpoints = device::find_usb_devices();
  if (!serial_number.empty()) {
    for (const auto& endpoint : endpoints)
      if (endpoint.serial_number == serial_number) return endpoint;
    throw NoDevice(fmt::format("No arm with the serial number {} is plugged in.", serial_number));
  }
  if (endpoints.empty())
    throw NoDevice("No arm was found on USB. Plug one in, or open \"virtual\" for a simulated one.");
  if (endpoints.size() == 1) return endpoints.front();
  std::string numbers;
  for (const auto& endpoint : endpoints) numbers += " " + endpoint.serial_number;
  throw NoDevice(fmt::format("{} arms are plugged in. Open one by its serial number:{}.", endpoints.size(), numbers));
}

/// Boards that run at the same time have serial numbers of their own.
std::uint64_t next_seed() {
  static std::atomic<std::uint64_t> boards = 0;
  return static_cast<std::uint64_t>(getpid()) << 16 | ++boards;
}

template <std::size_t size>
void copy(const std::string& text, char (&to)[size]) {
  std::strncpy(to, text.c_str(), size - 1);
}

inkwell_device entry(const std::string& address, const device::Endpoint& endpoint) {
  inkwell_device device{};
  copy(address, device.address);
  copy(endpoint.serial_number, device.serial_number);
  copy(endpoint.product, device.product);
  device.is_virtual = endpoint.is_virtual ? 1 : 0;
  return device;
}

}  // namespace

Address resolve(const std::string& given) {
  const std::string address = given.empty() ? environment_address() : given;
  if (address == own_board || address.starts_with(virtual_scheme)) {
    device::VirtualBoardOptions options;
    options.seed = next_seed();
    if (address != own_board) options.arm = address.substr(std::strlen(virtual_scheme));
    return {options, std::nullopt};
  }
  if (address.starts_with(usbip_scheme)) return {std::nullopt, find_usbip(address.substr(std::strlen(usbip_scheme)))};
  return {std::nullopt, find_usb(address)};
}

std::vector<inkwell_device> list_devices() {
  std::vector<inkwell_device> devices;
  for (const auto& endpoint : device::find_usb_devices()) devices.push_back(entry(endpoint.serial_number, endpoint));
  const std::string address = environment_address();
  if (address.starts_with(usbip_scheme)) {
    devices.push_back(entry(address, find_usbip(address.substr(std::strlen(usbip_scheme)))));
  } else if (address == own_board || address.starts_with(virtual_scheme)) {
    device::Endpoint endpoint{};
    endpoint.is_virtual = true;
    devices.push_back(entry(address, endpoint));
  }
  return devices;
}

}  // namespace inkwell::library
