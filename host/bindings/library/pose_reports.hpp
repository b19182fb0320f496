// Counts lost poses, and passes every pose report to a running recording.
#pragma once

#include <cstdint>
#include <functional>
#include <mutex>
#include <optional>

#include "host/client/device/wide_reports.hpp"

namespace inkwell::library {

class PoseReports {
 public:
  using Listener = std::function<void(const device::Pose&)>;

  /// Called by the pose thread.
  void take(const device::Pose& report) {
    const std::lock_guard lock(mutex_);
    if (newest_ && report.sequence > *newest_ + 1) lost_ += static_cast<std::uint64_t>(report.sequence - *newest_ - 1);
    newest_ = report.sequence;
    if (listener_) listener_(report);
  }
  /// Called by the pose thread for a new link, whose sequence numbers do not continue the previous ones.
  void start_link() {
    const std::lock_guard lock(mutex_);
    newest_.reset();
  }

  /// Number of poses that the board has sent and the library has not received since the arm was opened.
  std::uint64_t lost() const {
    const std::lock_guard lock(mutex_);
    return lost_;
  }
  /// When this function returns, the previous listener is not running.
  void listen(Listener listener) {
    const std::lock_guard lock(mutex_);
    listener_ = std::move(listener);
  }

 private:
  mutable std::mutex mutex_;
  std::optional<std::int64_t> newest_;
  std::uint64_t lost_ = 0;
  Listener listener_;
};

}  // namespace inkwell::library
