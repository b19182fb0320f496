// Stores the newest pose of each waiting thread. Thread-local storage is unsuitable, because static destructors may
// call the library later.
#pragma once

#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

#include "host/bindings/library/priority.hpp"

namespace inkwell::library {

class SeenPoses {
 public:
  SeenPoses() { inherit_priority(mutex_); }

  /// Returns the sequence number of the calling thread's newest pose, if any.
  std::optional<std::uint32_t> newest() const {
    const std::lock_guard lock(mutex_);
    const auto seen = threads_.find(std::this_thread::get_id());
    return seen == threads_.end() ? std::nullopt : std::optional(seen->second.sequence);
  }
  void note(std::uint32_t sequence) {
    const std::lock_guard lock(mutex_);
    threads_[std::this_thread::get_id()].sequence = sequence;
  }

  /// Records a force of the calling thread.
  void note_force() {
    const std::lock_guard lock(mutex_);
    const auto seen = threads_.find(std::this_thread::get_id());
    if (seen != threads_.end()) seen->second.drives = true;
  }
  /// Returns true if the calling thread has set a force since its last pose.
  bool take_force() {
    const std::lock_guard lock(mutex_);
    const auto seen = threads_.find(std::this_thread::get_id());
    return seen != threads_.end() && std::exchange(seen->second.drives, false);
  }

 private:
  struct Seen {
    std::uint32_t sequence = 0;
    bool drives = false;
  };
  mutable std::mutex mutex_;
  std::map<std::thread::id, Seen> threads_;
};

}  // namespace inkwell::library
