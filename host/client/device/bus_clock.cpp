#include "host/client/device/bus_clock.hpp"

namespace inkwell::device {

double BusClock::periods_between(const Moment& from, const Moment& to) {
  return static_cast<double>(to.periods - from.periods) + to.period_share - from.period_share;
}

void BusClock::note(const BusFrame& bus_frame) {
  const Moment moment{bus_frame.sequence, bus_frame.time_periods, bus_frame.time_cycles / cycles_per_period_};
  if (newest_ && moment.sequence < newest_->sequence) oldest_.reset();
  newest_ = moment;
  if (!oldest_) oldest_ = moment;
  const std::int64_t bus_frames = moment.sequence - oldest_->sequence;
  if (bus_frames != 0) periods_per_bus_frame_ = periods_between(*oldest_, moment) / static_cast<double>(bus_frames);
}

std::optional<double> BusClock::host_time_s(std::int64_t time_periods) const {
  if (!newest_) return std::nullopt;
  const double bus_frames = periods_between(*newest_, {0, time_periods, 0.0}) / periods_per_bus_frame_;
  return (static_cast<double>(newest_->sequence) + bus_frames) / protocol::pose_rate_Hz;
}

}  // namespace inkwell::device
