// After a loss of the device: which of its values are not what they were, until the user has settled that.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <device_desk/device_desk.hpp>

namespace inkwell::window {

class ReturnedValues {
 public:
  struct Row {
    protocol::Parameter parameter;
    float before;
    float now;
  };

  /// Call once a frame.
  void follow(const DeviceView& view, double now_s);
  /// Whether there is something to say: for some seconds that the values are the same, and that others are not until
  /// they are, or the user has changed them or wants to keep them.
  bool is_shown() const { return is_shown_; }
  /// Whether it is for the user to say which values hold.
  bool waits_for_user() const { return is_shown_ && !rows_.empty(); }
  /// Empty: the device holds what it held before.
  const std::vector<Row>& rows() const { return rows_; }
  /// What gives the device the values of before.
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
