// Parameter values before and after a reconnection. If the values differ, the user chooses between the old values and
// the new values.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "host/companion/window/device_desk/device_desk.hpp"

namespace inkwell::window {

class ReturnedValues {
 public:
  struct Row {
    protocol::Parameter parameter;
    float before;
    float now;
  };

  /// Call once per frame.
  void follow(const DeviceView& view, double now_s);
  /// Returns true while the card is shown. A card with equal values closes after a few seconds. A card with different
  /// values remains until the user decides or the values change.
  bool is_shown() const { return is_shown_; }
  /// Returns true while the user must choose between the values.
  bool waits_for_user() const { return is_shown_ && !rows_.empty(); }
  /// Returns the parameters with changed values.
  const std::vector<Row>& rows() const { return rows_; }
  /// Returns the changes that restore the previous values.
  std::vector<device::ParameterChange> changes_back() const;
  void dismiss() { is_shown_ = false; }

 private:
  void compare(const device::Reconnection& reconnection, double now_s);

  std::uint64_t seen_ = 0;
  bool is_shown_ = false;
  double shown_since_s_ = 0;
  std::vector<Row> rows_;
};

}  // namespace inkwell::window
