#include "host/companion/window/device_desk/stored_values.hpp"

#include <fmt/format.h>

namespace inkwell::window {

using protocol::StoreContents;
using protocol::StoreResult;

std::vector<protocol::Parameter> not_stored(const DeviceView& view) {
  if (!view.parameters || !view.status.store) return {};
  return device::not_stored(*view.parameters, *view.status.store);
}

std::string stored_title(const DeviceView& view) {
  if (!view.parameters || !view.status.store) return {};
  const std::size_t count = not_stored(view).size();
  if (count > 0) return fmt::format("{} value{} not stored", count, count == 1 ? " is" : "s are");
  return view.status.store->report.contents == StoreContents::parameters ? "All values are stored"
                                                                         : "All values are defaults";
}

std::string why_storing_waits(const DeviceView& view) {
  if (!view.connected() || !view.status.store) return "No device is connected. Plug in a device.";
  if (view.status.is_storing) return "The board is writing its flash memory.";
  if (!protocol::may_store(view.state())) return std::string(info(StoreResult::force_is_on).remedy);
  if (view.status.store->report.stores_left == 0) return std::string(info(StoreResult::no_room).remedy);
  return {};
}

}  // namespace inkwell::window
