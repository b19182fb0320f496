// Calls a program's servo function for each pose in a separate thread. Lost poses or a lost force stop the servo.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>

#include "host/client/process/fork.hpp"

#include "host/bindings/library/pose_feed.hpp"
#include "host/bindings/library/pose_reports.hpp"

namespace inkwell::library {

class Servo {
 public:
  /// Writes the force on the hand to `force_N`, which is initially 0. The servo stops if the function returns false or
  /// throws.
  using Function = std::function<bool(const inkwell_pose& pose, double (&force_N)[3])>;
  /// Receives each force and the sequence number of its pose. An exception of this function stops the servo.
  using Output = std::function<void(const double (&force_N)[3], std::uint32_t pose_sequence)>;

  /// `let_go` is called when a servo has stopped.
  Servo(const PoseFeed& poses, Output output, std::function<void()> let_go, const PoseReports* reports = nullptr);
  /// Waits until a running call returns.
  ~Servo();

  /// Throws NotNow if a servo is running.
  void start(Function function);
  /// Requests a stop after the running servo call.
  void request_end();
  /// Stops the servo and waits until its last call has returned. A call from the servo itself does not wait.
  void stop();
  bool is_running() const;
  /// Throws the error that stopped the last servo: lost poses, lost force, or another driver. Does not throw if the
  /// program or the servo function stopped the servo.
  void throw_what_ended_it() const;
  /// Sets the scheduling priority of the servo's thread, as in set_priority().
  void set_thread_priority(int priority) { set_priority(thread_, priority); }
  /// Losses of all servos of this object.
  struct Losses {
    std::uint64_t poses_missed = 0;  ///< arrived while the servo was still running
    std::uint64_t slow_calls = 0;    ///< took longer than a bus frame
    double longest_call_s = 0;
  };
  Losses losses() const;
  bool is_caller() const { return std::this_thread::get_id() == thread_.get_id(); }

 private:
  void run();
  void call(const Function& function, std::uint64_t known_interruptions);

  const PoseFeed& poses_;
  const PoseReports* const reports_;  ///< counts lost poses; may be null
  const Output output_;
  const std::function<void()> let_go_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  Function function_;                      ///< function of the running servo
  std::uint64_t known_interruptions_ = 0;  ///< count of interruptions when the servo was started
  std::exception_ptr ended_by_;
  bool runs_ = false, closes_ = false;
  Losses losses_;
  std::uint64_t started_ = 0;  ///< number of servos started so far
  std::atomic<bool> is_to_end_ = false;
  const process::Origin origin_;
  std::thread thread_;
};

}  // namespace inkwell::library
