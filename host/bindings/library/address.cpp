#include "host/bindings/library/address.hpp"

#include <unistd.h>

#include <atomic>
#include <cstdlib>

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

}  // namespace

OpenedArm open_arm(const std::string& given, device::LockStep* lock_step) {
  const auto address = device::parse_address(given.empty() ? environment_address() : given);
  const bool is_stepped = address.seed.has_value();
  // A stepped board stays paused until the arm is open.
  device::VirtualBoardOptions board{
      .seed = next_seed(), .real_time = !is_stepped, .paused = is_stepped, .lock_step = true};
  OpenedArm opened{device::open_arm(address, board, lock_step), is_stepped};
  if (is_stepped) opened.arm.control->resume();
  return opened;
}

std::vector<inkwell_device> list_devices() {
  std::vector<inkwell_device> devices;
  for (const auto& endpoint : device::find_usb_devices())
    devices.push_back(entry(device::address_of(endpoint), endpoint));
  const std::string configured = environment_address();
  try {
    const auto address = device::parse_address(configured);
    if (address.kind == device::Address::Kind::usbip) devices.push_back(entry(configured, device::find_arm(address)));
    if (address.kind == device::Address::Kind::own_board) {
      device::Endpoint endpoint{};
      endpoint.is_virtual = true;
      devices.push_back(entry(configured, endpoint));
    }
  } catch (const device::Error&) {  // a stale address must not hide the arms on USB; inkwell_open() reports its cause
  }
  return devices;
}

}  // namespace inkwell::library
