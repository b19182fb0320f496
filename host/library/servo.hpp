// The thread that calls a program's servo at each pose, until the poses or the force are lost.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>

#include <process/fork.hpp>

#include "pose_feed.hpp"

namespace inkwell::library {

class Servo {
 public:
  /// Writes the force on the hand, which is 0 before. False ends the servo, and so do its exceptions.
  using Function = std::function<bool(const inkwell_pose& pose, double (&force_N)[3])>;
  /// Where its forces go, with the sequence of the pose that each one answers. What it throws ends the servo.
  using Output = std::function<void(const double (&force_N)[3], std::uint32_t pose_sequence)>;

  /// `let_go` is called when a servo has ended.
  Servo(const PoseFeed& poses, Output output, std::function<void()> let_go);
  /// Waits for a call that is under way.
  ~Servo();

  /// Throws NotNow if one runs.
  void start(Function function);
  /// Its call that is under way is the last one.
  void ask_to_end();
  /// The same, and waits until it is not called any more, unless it is the servo itself who calls.
  void stop();
  bool is_running() const;
  /// Throws what ended the last servo, if neither the program nor its function did: lost poses, a lost force, or
  /// another program that drives.
  void throw_what_ended_it() const;
  bool is_caller() const { return std::this_thread::get_id() == thread_.get_id(); }

 private:
  void run();
  void call(const Function& function, std::uint64_t known_interruptions);

  const PoseFeed& poses_;
  const Output output_;
  const std::function<void()> let_go_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  Function function_;                      ///< that is to be called from now on
  std::uint64_t known_interruptions_ = 0;  ///< of the poses, when it was started
  std::exception_ptr ended_by_;
  bool runs_ = false, closes_ = false;
  std::uint64_t started_ = 0;  ///< so many servos have been
  std::atomic<bool> is_to_end_ = false;
  const process::Origin origin_;
  std::thread thread_;
};

}  // namespace inkwell::library
