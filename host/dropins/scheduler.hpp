// HDAPI's servo loop: one thread that calls the program's callbacks, the higher priority first, once in each tick.
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

#include <process/fork.hpp>

#include "constants.hpp"

namespace inkwell::dropins {

class Scheduler {
 public:
  /// Waits for the next tick; `poses` of the device make one. Returns soon when `ends` says so; else the time from tick
  /// to tick in seconds, 0 if that is not known.
  using Pace = std::function<double(std::uint32_t poses, const std::function<bool()>& ends)>;

  /// `end_tick` is called after the callbacks of each tick.
  Scheduler(Pace pace, std::function<void()> end_tick);

  /// Throws std::system_error if the system has no thread for it. One that runs goes on.
  void start();
  /// Waits for the callback that runs, unless it is the one who calls; false if that takes longer than `limit`. The
  /// callbacks stay listed.
  bool stop(std::chrono::milliseconds limit);
  bool runs() const;

  /// False for a rate at which no device sends poses.
  bool set_rate(unsigned long rate_Hz);
  int rate_Hz() const;
  /// Of the last tick, by the clock of the device that paces, and the rate that is set while that is not known.
  double measured_rate_Hz() const;

  /// invalid_handle if there are as many as it takes. By the servo thread it is called at once, before it is listed.
  TaskHandle add(Callback callback, void* user, unsigned short priority);
  /// Returns when it is done; at once after one call if no servo thread runs or it is the one who calls.
  bool run_until_done(Callback callback, void* user, unsigned short priority);
  /// False if it is listed no more. It is not being called when this returns, except by itself.
  bool remove(TaskHandle handle);
  bool is_listed(TaskHandle handle) const;
  /// True when it is done; false if the servo thread calls, or ends meanwhile.
  bool wait_until_done(TaskHandle handle);

  double time_since_tick_s() const;
  /// The number of the tick, for who is called in it.
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
  /// False in a child that a callback has forked.
  bool tick();
  /// Takes a task off the list, and waits until it is not being called.
  class OffTheList;

  const Pace pace_;
  const std::function<void()> end_tick_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  Tasks tasks_;  ///< in the order of their calls
  TaskHandle last_handle_ = 0, called_ = 0;
  bool runs_ = false, ends_ = false;
  std::uint32_t poses_in_tick_ = 1;
  std::atomic<std::thread::id> servo_thread_id_{};
  std::atomic<std::uint64_t> ticks_ = 0;
  std::atomic<std::chrono::steady_clock::time_point> tick_began_{};
  std::atomic<double> measured_rate_Hz_ = 0.0;  ///< 0 if it is not known
  const process::Origin origin_;
  std::thread thread_;
};

}  // namespace inkwell::dropins
