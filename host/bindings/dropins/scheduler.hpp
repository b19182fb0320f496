// HDAPI's servo loop: one thread that calls the program's callbacks once per tick, in the order of their priority.
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
  /// Waits for the next tick, that is, for this number of poses of the device. Returns early if `ends` returns true.
  /// Returns the time between the ticks in seconds, or 0 if it is unknown.
  using Pace = std::function<double(std::uint32_t poses, const std::function<bool()>& ends)>;

  /// `end_tick` is called after the callbacks of each tick.
  Scheduler(Pace pace, std::function<void()> end_tick);

  /// Throws std::system_error if the system cannot create the thread. A running scheduler continues.
  void start();
  /// Waits for the running callback, unless the callback itself calls this function. False if the wait exceeds `limit`.
  /// The callbacks remain listed.
  bool stop(std::chrono::milliseconds limit);
  bool runs() const;

  /// False if no device can send poses at this rate.
  bool set_rate(unsigned long rate_Hz);
  int rate_Hz() const;
  /// Rate of the last tick, measured in the time of the pacing device. If this rate is unknown, returns the set rate.
  double measured_rate_Hz() const;

  /// Returns invalid_handle if the list is full. In the servo thread, the callback is called once before it is listed.
  TaskHandle add(Callback callback, void* user, unsigned short priority);
  /// Returns when the callback is done. Without a servo thread, or in the servo thread, the callback is called once.
  bool run_until_done(Callback callback, void* user, unsigned short priority);
  /// False if the callback is not listed. On return the callback is not running, unless it calls this function itself.
  bool remove(TaskHandle handle);
  bool is_listed(TaskHandle handle) const;
  /// True when the callback is done; false in the servo thread, or if the scheduler stops.
  bool wait_until_done(TaskHandle handle);

  double time_since_tick_s() const;
  /// The number of the current tick in the servo thread; none in other threads.
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
  /// Runs the tasks of one tick. Returns false if a callback has forked and this is the child process.
  bool tick();
  /// Removes a task from the list, and waits until the task is not running.
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
