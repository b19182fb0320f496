#include "host/bindings/dropins/devices.hpp"

#include <algorithm>
#include <chrono>
#include <stdexcept>
#include <string_view>
#include <thread>
#include <utility>

#include <fmt/format.h>

#include "host/bindings/dropins/device_names.hpp"
#include "host/bindings/dropins/errors.hpp"

namespace inkwell::dropins {
namespace {

using namespace std::chrono_literals;

/// HDAPI names of the default device.
constexpr std::string_view default_names[] = {"", "Default Device", "Default PHANToM"};

/// Throws std::runtime_error for an invalid address.
inkwell_address_kind kind_of(const std::string& address) {
  inkwell_address_kind kind{};
  if (inkwell_kind_of_address(address.c_str(), &kind) != INKWELL_OK) throw std::runtime_error(inkwell_error_text());
  return kind;
}

/// Returns true if inkwell_open() starts a new virtual board for this address.
bool makes_a_board(const std::string& address) { return kind_of(address) == INKWELL_OWN_BOARD; }

thread_local Handle current_here = invalid_handle;

std::vector<inkwell_device> list_arms() {
  std::size_t count = 0;
  if (inkwell_list_devices(nullptr, 0, &count) != INKWELL_OK) return {};
  std::vector<inkwell_device> arms(count);
  if (inkwell_list_devices(arms.data(), arms.size(), &count) != INKWELL_OK) return {};
  arms.resize(std::min(count, arms.size()));
  return arms;
}

}  // namespace

std::string Devices::address_for(const std::string& name) const {
  if (kind_of(name) != INKWELL_ON_USB) return name;
  const auto arms = list_arms();
  for (const auto& arm : arms)
    if (!name.empty() && (name == arm.serial_number || name == arm.address)) return arm.address;
  const auto names = list_names();
  const auto configured = configured_arm(names);
  // INKWELL_DEVICE without a name selects one arm for all names that the program uses.
  if (!name.empty() && (configured.address.empty() || configured.has_name))
    if (const std::string bound = bound_address(names, name); !bound.empty()) return bound;
  // A program-specific name such as "Left" selects the next arm that this program has not opened.
  const auto is_open = [this](const std::string& address) {
    return !makes_a_board(address) && std::any_of(devices_.begin(), devices_.end(), [&](const auto& device) {
      return device && device->address() == address;
    });
  };
  if (!configured.address.empty() && !is_open(configured.address)) return configured.address;
  for (const auto& arm : arms)
    if (!is_open(arm.address)) return arm.address;
  if (!arms.empty())
    throw std::runtime_error(fmt::format(
        "There is no arm for the name {}: this program has opened each of the {} there are.", name, arms.size()));
  return {};  // none: inkwell_open() reports this
}

Handle Devices::open(const char* given) {
  const std::lock_guard one_at_a_time(opening_);
  std::string name = given == nullptr ? "" : given;
  if (std::find(std::begin(default_names), std::end(default_names), name) != std::end(default_names)) name.clear();
  std::string address;
  Handle handle = 0;
  try {
    {
      const std::lock_guard lock(mutex_);
      const auto is_taken = [&](const auto& is_same) {
        const auto found =
            std::find_if(devices_.begin(), devices_.end(), [&](const auto& each) { return each && is_same(*each); });
        if (found != devices_.end()) raise(device_already_initiated, (*found)->handle());
        return found != devices_.end();
      };
      const auto has_address = [](const Device& device, const std::string& text) {
        return !text.empty() && !makes_a_board(text) && device.address() == text;
      };
      if (is_taken([&](const Device& device) { return device.name() == name || has_address(device, name); }))
        return invalid_handle;
      address = address_for(name);
      if (is_taken([&](const Device& device) { return has_address(device, address); })) return invalid_handle;
      const auto free_slot = std::find(devices_.begin(), devices_.end(), nullptr);
      handle = static_cast<Handle>(free_slot - devices_.begin());
    }
    auto device = std::make_shared<Device>(handle, name, address);
    const std::lock_guard lock(mutex_);
    if (handle == devices_.size()) devices_.emplace_back();
    handles_used_ = static_cast<Handle>(devices_.size());
    device->set_scheduler_runs(scheduler_runs_);
    devices_[handle] = std::move(device);
    current_ = current_here = handle;
    // Removes the errors of an earlier device with the same handle.
    forget_errors_of(handle);
    return handle;
  } catch (const std::exception& error) {
    raise(device_fault, invalid_handle, error.what());
    return invalid_handle;
  }
}

bool Devices::close(Handle handle) {
  std::shared_ptr<Device> device;
  {
    const std::lock_guard lock(mutex_);
    if (find(handle) == nullptr) return false;
    device = std::exchange(devices_[handle], nullptr);
    if (current_ == handle) current_ = invalid_handle;
  }
  // The scheduler may still use the device. The arm must be closed when this function returns.
  while (device.use_count() > 1) std::this_thread::sleep_for(1ms);
  return true;
}

void Devices::close_all() {
  for (Handle handle = 0;; ++handle) {
    {
      const std::lock_guard lock(mutex_);
      if (handle >= devices_.size()) return;
      if (!devices_[handle]) continue;
    }
    close(handle);
  }
}

void Devices::wait_until_forces_are_off() {
  std::vector<std::shared_ptr<Device>> devices;
  {
    const std::lock_guard lock(mutex_);
    devices = devices_;
  }
  for (const auto& device : devices)
    if (device) device->wait_until_force_is_off();
}

ParentsDevices Devices::as_parents() const {
  return handles_used_ > 0 ? ParentsDevices{origin_.process(), handles_used_} : parents_;
}

Device* Devices::find(Handle handle) {
  if (is_open(handle)) return devices_[handle].get();
  const bool is_parents = parents_.handles > 0 && (handle < parents_.handles || handle == invalid_handle);
  raise(bad_handle, handle,
        is_parents
            ? fmt::format("The device was opened by process {}. Open it again in this process.", parents_.process)
            : std::string());
  return nullptr;
}

std::shared_ptr<Device> Devices::hold_current() {
  const Handle handle = current_handle();
  return find(handle) == nullptr ? nullptr : devices_[handle];
}

Handle Devices::current_handle() const { return is_open(current_here) ? current_here : current_; }

void Devices::make_current_here(Handle handle) {
  if (is_open(handle)) current_here = handle;
}

bool Devices::make_current(Handle handle) {
  if (find(handle) == nullptr) return false;
  current_ = current_here = handle;
  return true;
}

void Devices::set_scheduler_runs(bool runs) {
  scheduler_runs_ = runs;
  for (const auto& device : devices_)
    if (device) device->set_scheduler_runs(runs);
}

void Devices::renew_forces() {
  for (const auto& device : devices_)
    if (device) device->renew_force();
}

std::shared_ptr<Device> Devices::pacing() {
  for (const auto& device : devices_)
    if (device && device->sends_poses()) return device;
  return nullptr;
}

}  // namespace inkwell::dropins
