// A task on a separate thread, so that the window never waits for a disk.
#pragma once

#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>

namespace inkwell::window {

class BackgroundTask {
 public:
  /// Requires is_running() == false. `task` returns an error message; empty on success.
  void start(std::function<std::string()> task) {
    {
      const std::scoped_lock lock(mutex_);
      is_running_ = true;
      result_.reset();
    }
    thread_ = std::jthread([this, task = std::move(task)] {
      std::string problem = task();
      const std::scoped_lock lock(mutex_);
      is_running_ = false;
      result_ = std::move(problem);
    });
  }
  bool is_running() const {
    const std::scoped_lock lock(mutex_);
    return is_running_;
  }
  /// After the end of the task, returns its result once.
  std::optional<std::string> take_result() {
    const std::scoped_lock lock(mutex_);
    return std::exchange(result_, std::nullopt);
  }

 private:
  mutable std::mutex mutex_;
  bool is_running_ = false;
  std::optional<std::string> result_;
  std::jthread thread_;  ///< last member, because the thread uses all members above
};

}  // namespace inkwell::window
