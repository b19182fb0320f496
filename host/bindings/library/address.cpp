#include "host/bindings/library/address.hpp"

#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cstdlib>

#include "host/client/device/arm_names.hpp"

#include "host/bindings/library/text_copy.hpp"

namespace inkwell::library {
namespace {

std::string environment_address() {
  const char* address = std::getenv("INKWELL_DEVICE");
  return address == nullptr ? std::string() : std::string(address);
}

/// Boards that run at the same time need different serial numbers.
std::uint64_t next_seed() {
  static std::atomic<std::uint64_t> boards = 0;
  return static_cast<std::uint64_t>(getpid()) << 16 | ++boards;
}

inkwell_device entry(const std::string& address, const device::Endpoint& endpoint) {
  inkwell_device device{};
  copy_text(address, device.address);
  copy_text(endpoint.serial_number, device.serial_number);
  copy_text(endpoint.product, device.product);
  device.is_virtual = endpoint.is_virtual ? 1 : 0;
  return device;
}

/// Appends the virtual board at this address. An address that does not answer adds nothing; inkwell_open() reports its
/// cause.
void append_virtual(std::vector<inkwell_device>& devices, const std::string& text) {
  const auto is_listed = [&](const inkwell_device& device) { return text == device.address; };
  try {
    const auto address = device::parse_address(text);
    if (address.kind == device::Address::Kind::usb || std::ranges::any_of(devices, is_listed)) return;
    if (address.kind == device::Address::Kind::usbip) return devices.push_back(entry(text, device::find_arm(address)));
    device::Endpoint endpoint{};
    endpoint.is_virtual = true;
    devices.push_back(entry(text, endpoint));
  } catch (const device::Error&) {
  }
}

/// Returns no names if the file is damaged, because the list must contain all arms. inkwell_open() reports the damage.
std::vector<device::NamedArm> readable_names() {
  try {
    return device::read_arm_names();
  } catch (const device::Error&) {
    return {};
  }
}

}  // namespace

OpenedArm open_arm(const std::string& given, device::LockStep* lock_step) {
  const auto address = device::named_address(given.empty() ? environment_address() : given);
  const bool is_stepped = address.seed.has_value();
  // A stepped board stays paused until the arm is open.
  device::VirtualBoardOptions board{
      .seed = next_seed(), .real_time = !is_stepped, .paused = is_stepped, .lock_step = true};
  OpenedArm opened{device::open_arm(address, board, lock_step), is_stepped};
  if (is_stepped) opened.arm.control->resume();
  return opened;
}

std::vector<inkwell_device> list_devices() {
  const auto names = readable_names();
  std::vector<inkwell_device> on_usb, devices;
  for (const auto& endpoint : device::find_usb_devices())
    on_usb.push_back(entry(device::address_of(endpoint), endpoint));
  for (const auto& arm : names) {
    const auto found = std::ranges::find_if(on_usb, [&](const auto& device) { return arm.address == device.address; });
    if (found == on_usb.end()) {
      append_virtual(devices, arm.address);
    } else {
      devices.push_back(*found);
      on_usb.erase(found);
    }
  }
  devices.insert(devices.end(), on_usb.begin(), on_usb.end());
  const std::string configured = environment_address();
  const auto* named = device::find_arm_name(names, configured);
  append_virtual(devices, named == nullptr ? configured : named->address);
  return devices;
}

std::vector<inkwell_named_arm> list_names() {
  std::vector<inkwell_named_arm> names;
  for (const auto& arm : device::read_arm_names()) {
    inkwell_named_arm named{};
    copy_text(arm.name, named.name);
    copy_text(arm.address, named.address);
    names.push_back(named);
  }
  return names;
}

}  // namespace inkwell::library
