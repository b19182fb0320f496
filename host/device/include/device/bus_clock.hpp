// The board's time on the clock of the USB host: a computer that follows several devices can put them on one line.
#pragma once

#include <optional>

#include <device/wide_reports.hpp>

namespace inkwell::device {

class BusClock {
 public:
  /// `cycles_per_period`: processor cycles of a control period, by the InformationReport.
  explicit BusClock(double cycles_per_period) : cycles_per_period_(cycles_per_period) {}

  /// To be given a frame now and then, once a second for instance.
  void note(const BusFrame& frame);

  /// Time of a control period in seconds of the host's frames, since the bus runs; none before the first frame, at the
  /// nominal rate before the second.
  std::optional<double> host_time_s(std::int64_t time_periods) const;

 private:
  struct Moment {
    std::int64_t sequence;
    std::int64_t periods;
    double period_share;  ///< of the period that had begun, 0 to 1
  };
  static double periods_between(const Moment& from, const Moment& to);

  double cycles_per_period_;
  std::optional<Moment> oldest_, newest_;
  double periods_per_frame_ = static_cast<double>(protocol::servo_rate_Hz) / protocol::pose_rate_Hz;
};

}  // namespace inkwell::device
