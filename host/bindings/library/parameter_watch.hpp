// Calls a check of the parameters twice per second during a recording.
#pragma once

#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>

namespace inkwell::library {

class ParameterWatch {
 public:
  /// `check` is called on a separate thread and must not throw.
  explicit ParameterWatch(std::function<void()> check) : check_(std::move(check)) {}
  ~ParameterWatch();

  void begin();
  /// Returns after the last call of `check`.
  void end();

 private:
  void run();

  std::function<void()> check_;
  std::mutex mutex_;
  std::condition_variable changed_;
  bool is_watching_ = false, is_checking_ = false, stops_ = false;
  std::thread thread_;  ///< started by the first begin()
};

}  // namespace inkwell::library
