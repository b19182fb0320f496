// A queue between the thread that receives transfers and the thread that reads them.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <deque>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "host/client/device/error.hpp"

namespace inkwell::device {

class TransferQueue {
 public:
  using Transfer = std::vector<std::byte>;

  void push(Transfer transfer) {
    const std::lock_guard lock(mutex_);
    transfers_.push_back(std::move(transfer));
    changed_.notify_one();
  }

  /// Queued transfers remain readable. Afterwards, `pop` throws Disconnected with `reason`.
  void close(std::string reason) {
    const std::lock_guard lock(mutex_);
    if (!closed_) closed_ = std::move(reason);
    changed_.notify_all();
  }

  std::optional<Transfer> pop(std::chrono::milliseconds timeout) {
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, timeout, [&] { return !transfers_.empty() || closed_; });
    if (!transfers_.empty()) {
      Transfer transfer = std::move(transfers_.front());
      transfers_.pop_front();
      return transfer;
    }
    if (closed_) throw Disconnected(*closed_);
    return std::nullopt;
  }

  void drop_oldest() {
    const std::lock_guard lock(mutex_);
    if (!transfers_.empty()) transfers_.pop_front();
  }

  std::size_t size() const {
    const std::lock_guard lock(mutex_);
    return transfers_.size();
  }

 private:
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Transfer> transfers_;
  std::optional<std::string> closed_;
};

}  // namespace inkwell::device
