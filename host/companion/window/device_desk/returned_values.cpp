#include "host/companion/window/device_desk/returned_values.hpp"

namespace inkwell::window {

namespace {
constexpr double repeat_interval_s = 6.0;
}

void ReturnedValues::compare(const device::Reconnection& reconnection, double now_s) {
  seen_ = reconnection.number;
  is_shown_ = true;
  shown_since_s_ = now_s;
  rows_.clear();
  for (std::size_t i = 0; i < protocol::known_parameters().size(); ++i)
    if (const float before = reconnection.before.values[i], now = reconnection.after.values[i]; before != now)
      rows_.push_back({static_cast<protocol::Parameter>(i), before, now});
}

void ReturnedValues::follow(const DeviceView& view, double now_s) {
  if (!view.reconnection || !view.parameters) {
    is_shown_ = false;
    return;
  }
  if (view.reconnection->number != seen_) compare(*view.reconnection, now_s);
  if (!is_shown_) return;
  if (rows_.empty()) {
    is_shown_ = now_s - shown_since_s_ < repeat_interval_s;
    return;
  }
  // Removes values that have changed since the reconnection, because the user no longer has to decide about these
  // values.
  std::erase_if(rows_, [&](const Row& row) { return (*view.parameters)[row.parameter] != row.now; });
  is_shown_ = !rows_.empty();
}

std::vector<device::ParameterChange> ReturnedValues::changes_back() const {
  std::vector<device::ParameterChange> changes;
  for (const Row& row : rows_) changes.emplace_back(row.parameter, row.before);
  return changes;
}

}  // namespace inkwell::window
