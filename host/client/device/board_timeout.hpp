// A time limit in board time.
#pragma once

#include <chrono>
#include <cmath>
#include <cstdint>
#include <optional>

#include "host/client/device/wide_reports.hpp"

namespace inkwell::device {

/// Counts board time, so that a slow computer does not shorten the limit. Wall time counts only while board time does
/// not advance.
class BoardTimeout {
 public:
  using Clock = std::chrono::steady_clock;

  BoardTimeout(double limit_s, Clock::duration silence)
      : limit_periods_(std::llround(limit_s * protocol::servo_rate_Hz)), silence_(silence) {}

  /// Records the newest known board time `now_periods`. Returns true if the limit is exceeded. The first call starts
  /// the limit.
  bool update_time(std::optional<std::int64_t> now_periods, Clock::time_point now = Clock::now()) {
    const std::int64_t newest = now_periods.value_or(unknown);
    if (!is_started_ || newest != newest_periods_) heard_at_ = now;
    if (began_periods_ == unknown) began_periods_ = newest;
    newest_periods_ = newest;
    is_started_ = true;
    const bool has_passed = newest != unknown && newest - began_periods_ > limit_periods_;
    return has_passed || now - heard_at_ > silence_;
  }
  bool update_time(const std::optional<Pose>& newest) {
    return update_time(newest ? std::optional(newest->time_periods) : std::nullopt);
  }

 private:
  static constexpr std::int64_t unknown = INT64_MIN;

  std::int64_t limit_periods_;
  Clock::duration silence_;
  bool is_started_ = false;
  std::int64_t began_periods_ = unknown, newest_periods_ = unknown;
  Clock::time_point heard_at_{};
};

}  // namespace inkwell::device
