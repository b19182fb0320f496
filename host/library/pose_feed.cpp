#include "pose_feed.hpp"

#include <algorithm>
#include <cmath>

#include "errors.hpp"

namespace inkwell::library {

Clock::time_point in(double seconds) {
  if (std::isnan(seconds)) throw BadArgument("The time-out is not a number. Give seconds, from 0 on.");
  return Clock::now() +
         std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(std::clamp(seconds, 0.0, 1e6)));
}

void PoseFeed::publish(const inkwell_pose& pose, bool is_referenced) {
  const std::lock_guard lock(mutex_);
  newest_ = pose;
  is_referenced_ = is_referenced;
  changed_.notify_all();
}

void PoseFeed::end(const std::string& reason) {
  const std::lock_guard lock(mutex_);
  if (!end_reason_) end_reason_ = reason;
  changed_.notify_all();
}

void PoseFeed::wake() const {
  const std::lock_guard lock(mutex_);
  changed_.notify_all();
}

std::optional<std::string> PoseFeed::end_reason() const {
  const std::lock_guard lock(mutex_);
  return end_reason_;
}

void PoseFeed::require_open(const std::unique_lock<std::mutex>&) const {
  if (end_reason_) throw device::Disconnected(*end_reason_);
}

void PoseFeed::require_open() const { require_open(std::unique_lock(mutex_)); }

inkwell_pose PoseFeed::newest() const {
  const std::unique_lock lock(mutex_);
  require_open(lock);
  return newest_;
}

bool PoseFeed::is_referenced() const {
  const std::unique_lock lock(mutex_);
  require_open(lock);
  return is_referenced_;
}

}  // namespace inkwell::library
