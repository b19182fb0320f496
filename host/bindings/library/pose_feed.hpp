// Distributes poses to all threads, and reports losses of poses, link and force.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <exception>
#include <functional>
#include <limits>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include <inkwell/inkwell.h>
#include "host/client/device/transport.hpp"
#include "host/client/process/cancellation.hpp"

#include "host/bindings/library/motion.hpp"
#include "host/bindings/library/priority.hpp"
#include "host/bindings/library/turns.hpp"

namespace inkwell::library {

using Clock = std::chrono::steady_clock;

/// No time-out.
inline constexpr double forever_s = std::numeric_limits<double>::infinity();

/// Returns the time-out, or 0 for a negative time-out. Throws BadArgument if the time-out is not a number.
double checked_timeout_s(double seconds);

/// Reason why no poses arrive.
enum class Loss : std::uint8_t {
  none,     ///< poses arrive
  silence,  ///< the link works, but the board sends no poses
  link,     ///< the link is lost, and the connection searches for the board
};

/// The pose thread calls these functions in each turn of lock step.
class TurnPart {
 public:
  virtual ~TurnPart() = default;
  /// Called before board time passes.
  virtual void before_pose() {}
  /// Called after the pose and all earlier data of the board have arrived.
  virtual void after_pose() {}
  /// Called when the link is lost. `cause` is a sentence.
  virtual void lose_link([[maybe_unused]] const std::string& cause) {}
};

class PoseFeed final : public device::LockStep {
 public:
  PoseFeed() { inherit_priority(mutex_); }

  // ---- pose thread ---------------------------------------------------------------------------------------------

  /// Switches to lock step with these turns.
  void take_turns(std::shared_ptr<Turns> turns, bool is_stepped);
  /// From this call on, the time of a stepped board passes only while a call waits. Call this function again after a
  /// lost link.
  void let_program_decide();
  /// Waits until the next pose may be requested. Without lock step, the function returns immediately. Returns false if
  /// the arm closes.
  bool begin_turn();
  /// Ends the wait of begin_turn() when the arm closes.
  void leave_turns();

  /// Publishes a pose and ends a loss of poses. In lock step, the function waits for the servos' answers and then
  /// notifies waiting calls.
  void publish(const inkwell_pose& pose, bool is_referenced, const Motion& motion = {});
  /// Reports a loss. `cause` is a sentence with the remedy. The newest cause replaces the previous cause.
  void lose(Loss kind, const std::string& cause);
  /// Reports the loss of this program's claim.
  void lose_claim(const std::string& cause);

  // ---- poses ---------------------------------------------------------------------------------------------------

  struct Seen {
    inkwell_pose pose{};
    bool is_referenced = false;  ///< whether the encoders are referenced
    Motion motion{};
  };
  /// Returns the newest known pose.
  Seen last() const;
  Loss loss() const;
  /// Passes the newest pose to `take`, then throws Disconnected during a loss.
  template <class Take>
  void read(Take take) const {
    const std::unique_lock lock(mutex_);
    take(seen_);
    require_poses(lock);
  }
  /// Does the same without exceptions and memory allocation. During a loss, it returns `refuse(result, sentence)`.
  template <class Take, class Refuse>
  inkwell_result read(Take take, Refuse refuse) const {
    const std::lock_guard lock(mutex_);
    take(seen_);
    return loss_ == Loss::none ? INKWELL_OK : refuse(INKWELL_DISCONNECTED, cause_.c_str());
  }
  /// Throws Disconnected during a loss.
  void require_poses() const;
  /// Throws Disconnected while the link is lost.
  void require_link() const;

  /// Waits until `condition(pose, loss)` is true. The time-out is in board time, or in wall time while no poses arrive.
  /// Returns the newest pose. Throws Disconnected while the link is lost, but not during a silence. `answer` states how
  /// the calling thread answers the pose.
  template <class Condition>
  inkwell_pose wait(Condition condition, double timeout_s = forever_s,
                    Turns::Answer answer = Turns::Answer::none) const {
    bool is_lost = false;  // the link may be restored before this thread runs
    const auto check = [&] {
      is_lost = loss_ == Loss::link;
      return is_lost || condition(seen_.pose, loss_);
    };
    const std::function<bool()> is_over = std::ref(check);  // a reference needs no memory allocation
    std::unique_lock lock(mutex_);
    const inkwell_pose pose = wait(lock, is_over, timeout_s, answer);
    if (is_lost) throw_loss(lock);
    return pose;
  }
  /// Makes all waiting calls check their conditions.
  void wake() const;

  // ---- the force ---------------------------------------------------------------------------------------------

  /// After this call, the library reports lost forces to this program.
  void use_force();
  /// Called when this program releases the arm. Until use_force() is called, lost forces are not reported.
  void stop_using_force();
  /// Called when this program switches the force on, or accepts that the force is off.
  void forget_lost_force();
  /// Called when this program switches the force off.
  void expect_force_off();
  /// Throws ForceLost after an unexpected loss of the force. The loss counts until the force is on, or until
  /// forget_lost_force() is called.
  void require_force() const;
  /// Returns `refuse(result, sentence)` during a loss of poses or force, without exceptions and memory allocation.
  /// Otherwise writes the sequence number of the newest pose.
  template <class Refuse>
  inkwell_result check_force(std::uint32_t& pose_sequence, Refuse refuse) const {
    const std::lock_guard lock(mutex_);
    if (loss_ != Loss::none) return refuse(INKWELL_DISCONNECTED, cause_.c_str());
    if (force_lost_) return refuse(INKWELL_FORCE_LOST, force_lost_->c_str());
    pose_sequence = seen_.pose.sequence;
    return INKWELL_OK;
  }
  bool uses_force() const;
  /// Returns true if the force was on since the link was opened.
  bool had_force() const;

  /// Returns the number of lost links, silences and lost forces. Each of these losses stops the running servo.
  std::uint64_t interruptions() const;
  /// Waits until `condition` is true and returns the newest pose. Throws the newest interruption if interruptions()
  /// differs from `known`. Only for servos. In lock step, board time stops from the return to the servo's next wait.
  template <class Condition>
  inkwell_pose wait_uninterrupted(std::uint64_t known, Condition condition) const {
    const auto check = [&] { return interruptions_ != known || condition(seen_.pose); };
    const std::function<bool()> is_over = std::ref(check);
    std::unique_lock lock(mutex_);
    const inkwell_pose pose = wait(lock, is_over, forever_s, Turns::Answer::servo);
    if (interruptions_ != known) std::rethrow_exception(interruption_);
    return pose;
  }

  // ---- lock step ---------------------------------------------------------------------------------------------

  bool is_in_lock_step() const { return turn_.has_value(); }
  /// Returns true if program code uses no board time, so that runs are repeatable.
  bool is_stepped() const { return is_stepped_; }
  /// Calls `part` in each turn until remove() is called. Only in lock step.
  void add(TurnPart& part);
  void remove(TurnPart& part);
  /// Stops board time until the thread has answered the pose. Has no effect outside lock step.
  void begin_answer(std::thread::id thread, Turns::Answer answer) const;
  void end_answer(std::thread::id thread) const;

  bool is_in_step() const override;
  bool wait(const std::function<bool()>& is_over, std::chrono::milliseconds patience) override;

 private:
  struct Waiter {
    const std::function<bool()>& is_over;
    double deadline_s;  ///< board time
    Turns::Answer answer;
    std::thread::id thread;
    bool is_in_servo = false;               ///< the servo waits for another event before it answers
    std::optional<inkwell_pose> pose = {};  ///< set when the wait is over
  };

  /// Registers a waiter for the lifetime of this object. Requires the mutex.
  class WaitingCall {
   public:
    WaitingCall(const PoseFeed& feed, Waiter& waiter);
    ~WaitingCall();
    WaitingCall(const WaitingCall&) = delete;
    WaitingCall& operator=(const WaitingCall&) = delete;

   private:
    const PoseFeed& feed_;
    Waiter& waiter_;
  };

  inkwell_pose wait(std::unique_lock<std::mutex>& lock, const std::function<bool()>& is_over, double timeout_s,
                    Turns::Answer answer) const;
  // The caller of the following functions must hold the mutex.
  void begin_waiting(Waiter& waiter) const;
  void end_waiting(const Waiter& waiter) const;
  enum class Waiting : std::uint8_t { servos, others, all };
  void release(Waiting which) const;
  void note(const inkwell_pose& pose, bool is_referenced, const Motion& motion);
  void note_loss(Loss kind, const std::string& cause);

  [[noreturn]] void throw_loss(const std::unique_lock<std::mutex>& lock) const;
  void require_link(const std::unique_lock<std::mutex>& lock) const;
  void require_poses(const std::unique_lock<std::mutex>& lock) const;
  void interrupt(std::exception_ptr by);
  void lose_force(const std::string& cause);

  mutable std::mutex mutex_;
  mutable std::condition_variable changed_;
  Seen seen_{};
  std::uint64_t poses_ = 0;
  mutable std::vector<Waiter*> waiters_;
  Loss loss_ = Loss::none;
  std::string cause_;  ///< cause of the loss
  bool uses_force_ = false, had_force_ = false, expects_force_off_ = false;
  std::optional<std::string> force_lost_;
  std::uint64_t interruptions_ = 0;
  std::exception_ptr interruption_;  ///< the newest interruption

  // These members are set before any other part is created.
  std::shared_ptr<Turns> turns_;      ///< null outside lock step
  std::optional<Turns::Board> turn_;  ///< none outside lock step
  bool is_stepped_ = false;
  std::thread::id reader_;     ///< set in lock step, from the first turn on
  bool is_requested_ = false;  ///< a pose was requested; used by the reader only
  std::mutex parts_mutex_;
  std::vector<TurnPart*> parts_;
};

}  // namespace inkwell::library
