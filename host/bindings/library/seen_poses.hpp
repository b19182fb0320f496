// Stores the newest pose of each waiting thread. Thread-local storage is unsuitable, because static destructors may
// call the library later.
#pragma once

#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <thread>

namespace inkwell::library {

class SeenPoses {
 public:
  /// Returns the sequence number of the calling thread's newest pose, if any.
  std::optional<std::uint32_t> newest() const {
    const std::lock_guard lock(mutex_);
    const auto seen = sequences_.find(std::this_thread::get_id());
    return seen == sequences_.end() ? std::nullopt : std::optional(seen->second);
  }
  void note(std::uint32_t sequence) {
    const std::lock_guard lock(mutex_);
    sequences_[std::this_thread::get_id()] = sequence;
  }

  /// Records a force of the calling thread.
  void note_force() {
    const std::lock_guard lock(mutex_);
    if (sequences_.contains(std::this_thread::get_id())) drives_.insert(std::this_thread::get_id());
  }
  /// Returns true if the calling thread has set a force since its last pose.
  bool take_force() {
    const std::lock_guard lock(mutex_);
    return drives_.erase(std::this_thread::get_id()) > 0;
  }

 private:
  mutable std::mutex mutex_;
  std::map<std::thread::id, std::uint32_t> sequences_;
  std::set<std::thread::id> drives_;
};

}  // namespace inkwell::library
