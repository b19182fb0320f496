// HDAPI servo loop. One thread calls the program's callbacks once per tick, in priority order.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include "host/client/process/fork.hpp"

#include "host/bindings/dropins/constants.hpp"

namespace inkwell::dropins {

class Scheduler {
 public:
  /// Waits for the next tick, which is due after `poses` poses of the device. Returns early if `ends` returns true.
  /// Returns the time between the ticks in seconds, or 0 if the time is unknown.
  using Pace = std::function<double(std::uint32_t poses, const std::function<bool()>& ends)>;

  /// The servo thread calls `end_tick` after the callbacks of each tick.
  Scheduler(Pace pace, std::function<void()> end_tick);

  /// Throws std::system_error if the system cannot create the thread. A running scheduler continues.
  void start();
  /// Waits for the running callback, unless the callback itself calls this function. Returns false if the wait exceeds
  /// `limit`. The callbacks remain listed.
  bool stop(std::chrono::milliseconds limit);
  bool runs() const;

  /// Returns false if no device can send poses at this rate.
  bool set_rate(unsigned long rate_Hz);
  int rate_Hz() const;
  /// Returns the rate of the last tick in board time. Returns the set rate if the board time is unknown.
  double measured_rate_Hz() const;

  /// Returns invalid_handle if the list is full. A call in the servo thread first calls the callback once.
  TaskHandle add(Callback callback, void* user, unsigned short priority);
  /// Returns when the callback is done. In the servo thread, or if no servo thread runs, the function calls the
  /// callback once.
  bool run_until_done(Callback callback, void* user, unsigned short priority);
  /// Returns false if the callback is not listed. On return the callback is not running, unless the callback itself
  /// made this call.
  bool remove(TaskHandle handle);
  bool is_listed(TaskHandle handle) const;
  /// Returns true when the callback is done. Returns false in the servo thread, or if the scheduler stops.
  bool wait_until_done(TaskHandle handle);

  double time_since_tick_s() const;
  /// Returns the current tick number in the servo thread, and none in other threads.
  std::optional<std::uint64_t> tick_of_caller() const;

 private:
  struct Task {
    TaskHandle handle;
    Callback callback;
    void* user;
    unsigned short priority;
  };
  using Tasks = std::vector<std::shared_ptr<const Task>>;

  bool is_servo_thread() const { return std::this_thread::get_id() == servo_thread_id_; }
  TaskHandle list(Callback callback, void* user, unsigned short priority);
  Tasks::const_iterator find(TaskHandle handle) const;
  void loop();
  /// Runs the tasks of one tick. Returns false in the child process if a callback has called fork().
  bool tick();
  class OffTheList;

  const Pace pace_;
  const std::function<void()> end_tick_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  Tasks tasks_;  ///< in calling order
  TaskHandle last_handle_ = 0, called_ = 0;
  bool runs_ = false, ends_ = false;
  std::uint32_t poses_in_tick_ = 1;
  std::atomic<std::thread::id> servo_thread_id_{};
  std::atomic<std::uint64_t> ticks_ = 0;
  std::atomic<std::chrono::steady_clock::time_point> tick_began_{};
  std::atomic<double> measured_rate_Hz_ = 0.0;  ///< 0 if it is unknown
  const process::Origin origin_;
  std::thread thread_;
};

}  // namespace inkwell::dropins
