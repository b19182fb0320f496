// Which pose each thread of a program has waited for last. It belongs to its arm and not to the threads: programs call
// in from their last destructors, when what belongs to a thread is gone already.
#pragma once

#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <thread>

namespace inkwell::library {

class SeenPoses {
 public:
  /// Of the calling thread; none before its first.
  std::optional<std::uint32_t> newest() const {
    const std::lock_guard lock(mutex_);
    const auto seen = sequences_.find(std::this_thread::get_id());
    return seen == sequences_.end() ? std::nullopt : std::optional(seen->second);
  }
  void note(std::uint32_t sequence) {
    const std::lock_guard lock(mutex_);
    sequences_[std::this_thread::get_id()] = sequence;
  }

 private:
  mutable std::mutex mutex_;
  std::map<std::thread::id, std::uint32_t> sequences_;
};

}  // namespace inkwell::library
