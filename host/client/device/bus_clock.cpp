#include "host/client/device/bus_clock.hpp"

namespace inkwell::device {

double BusClock::periods_between(const Moment& from, const Moment& to) {
  return static_cast<double>(to.periods - from.periods) + to.period_share - from.period_share;
}

void BusClock::note(const BusFrame& frame) {
  const Moment moment{frame.sequence, frame.time_periods, frame.time_cycles / cycles_per_period_};
  // The sequence decreases only when the board restarts.
  if (newest_ && moment.sequence < newest_->sequence) oldest_.reset();
  newest_ = moment;
  if (!oldest_) oldest_ = moment;
  const std::int64_t frames = moment.sequence - oldest_->sequence;
  if (frames != 0) periods_per_frame_ = periods_between(*oldest_, moment) / static_cast<double>(frames);
}

std::optional<double> BusClock::host_time_s(std::int64_t time_periods) const {
  if (!newest_) return std::nullopt;
  const double frames = periods_between(*newest_, {0, time_periods, 0.0}) / periods_per_frame_;
  return (static_cast<double>(newest_->sequence) + frames) / protocol::pose_rate_Hz;
}

}  // namespace inkwell::device
