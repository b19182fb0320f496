// Converts board time to the clock of the USB host. With this clock, a computer can align the data of several devices.
#pragma once

#include <optional>

#include "host/client/device/wide_reports.hpp"

namespace inkwell::device {

class BusClock {
 public:
  /// `cycles_per_period` is the number of processor cycles per control period.
  explicit BusClock(double cycles_per_period) : cycles_per_period_(cycles_per_period) {}

  /// Call this regularly with the newest bus frame, for example once per second.
  void note(const BusFrame& bus_frame);

  /// Returns the time of a control period in seconds since the start of the bus. Returns std::nullopt before the first
  /// bus frame. Uses the nominal rate before the second bus frame.
  std::optional<double> host_time_s(std::int64_t time_periods) const;

 private:
  struct Moment {
    std::int64_t sequence;
    std::int64_t periods;
    double period_share;  ///< elapsed fraction of the current period, 0 to 1
  };
  static double periods_between(const Moment& from, const Moment& to);

  double cycles_per_period_;
  std::optional<Moment> oldest_, newest_;
  double periods_per_bus_frame_ = static_cast<double>(protocol::servo_rate_Hz) / protocol::pose_rate_Hz;
};

}  // namespace inkwell::device
