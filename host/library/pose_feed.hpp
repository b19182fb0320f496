// The newest pose for every thread that wants it, and the end of the link, which all of them hear.
#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <optional>
#include <string>

#include <inkwell/inkwell.h>

namespace inkwell::library {

using Clock = std::chrono::steady_clock;

/// So many seconds from now. Throws BadArgument for what is no number.
Clock::time_point in(double seconds);

class PoseFeed {
 public:
  void publish(const inkwell_pose& pose, bool is_referenced);
  /// The link is lost and no pose comes any more; the first reason counts.
  void end(const std::string& reason);
  std::optional<std::string> end_reason() const;
  /// Throws Disconnected after the end.
  void require_open() const;

  /// Throws Disconnected after the end.
  inkwell_pose newest() const;
  /// Whether the arm knows its place, by the newest pose. Throws Disconnected after the end.
  bool is_referenced() const;
  /// The newest pose, once it fulfils the condition or the time is over. Throws Disconnected after the end.
  template <class Condition>
  inkwell_pose wait(Condition condition, Clock::time_point give_up_at = Clock::time_point::max()) const {
    std::unique_lock lock(mutex_);
    changed_.wait_until(lock, give_up_at, [&] { return end_reason_ || condition(newest_); });
    require_open(lock);
    return newest_;
  }
  /// Lets those who wait look at their conditions again.
  void wake() const;

 private:
  void require_open(const std::unique_lock<std::mutex>& lock) const;

  mutable std::mutex mutex_;
  mutable std::condition_variable changed_;
  inkwell_pose newest_{};
  bool is_referenced_ = false;
  std::optional<std::string> end_reason_;
};

}  // namespace inkwell::library
