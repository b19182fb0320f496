// Informs all threads of the newest pose, and of losses of the poses, the link and the force.
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

#include "host/bindings/library/turns.hpp"

namespace inkwell::library {

using Clock = std::chrono::steady_clock;

/// No time-out.
inline constexpr double forever_s = std::numeric_limits<double>::infinity();

/// Returns the time-out of a call, at least 0. Throws BadArgument if the time-out is not a number.
double checked_timeout_s(double seconds);

/// Reason why no poses arrive.
enum class Loss : std::uint8_t {
  none,     ///< poses arrive
  silence,  ///< the link works, but the board sends no poses
  link,     ///< the link is lost, and the connection searches for the board
};

/// Task of the pose thread in each turn. Used in lock step only.
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
  // ---- for the thread that reads the poses ---------------------------------------------------------------------

  /// Switches to lock step with these turns. After let_program_decide(), if `is_stepped`, board time passes only while
  /// a call waits.
  void take_turns(std::shared_ptr<Turns> turns, bool is_stepped);
  /// From this call on, the program decides when time passes. Call this again after a lost link.
  void let_program_decide();
  /// Waits until the next pose may be requested. Without lock step, a request is always allowed. False if the arm
  /// closes.
  bool begin_turn();
  /// Called when the arm closes, so that begin_turn() no longer waits.
  void leave_turns();

  /// Publishes a pose, which ends a loss. In lock step the function returns after the servos have answered the pose and
  /// the waiting calls were notified.
  void publish(const inkwell_pose& pose, bool is_referenced);
  /// Reports a loss. `cause` is a sentence with the remedy; the newest cause replaces earlier causes.
  void lose(Loss kind, const std::string& cause);
  /// This program has lost its claim to the arm.
  void lose_claim(const std::string& cause);

  // ---- poses ---------------------------------------------------------------------------------------------------

  struct Seen {
    inkwell_pose pose{};
    bool is_referenced = false;  ///< whether the encoders are referenced
  };
  /// The newest pose, also during a loss.
  Seen last() const;
  Loss loss() const;
  /// Passes the newest pose to `take`, then throws Disconnected during a loss.
  template <class Take>
  void read(Take take) const {
    const std::unique_lock lock(mutex_);
    take(seen_);
    require_poses(lock);
  }
  /// Throws Disconnected during a loss.
  void require_poses() const;
  /// Throws Disconnected while the link is lost.
  void require_link() const;

  /// Waits until `condition(pose, loss)` is true. Also returns after this board time, or after the same wall time
  /// without a pose. Returns the newest pose. Throws Disconnected while the link is lost, but not during a silence.
  /// `answer` states how the calling thread answers the pose.
  template <class Condition>
  inkwell_pose wait(Condition condition, double timeout_s = forever_s,
                    Turns::Answer answer = Turns::Answer::none) const {
    bool is_lost = false;  // the link may be restored before this thread runs
    const std::function<bool()> is_over = [&] {
      is_lost = loss_ == Loss::link;
      return is_lost || condition(seen_.pose, loss_);
    };
    std::unique_lock lock(mutex_);
    const inkwell_pose pose = wait(lock, is_over, timeout_s, answer);
    if (is_lost) throw_loss(lock);
    return pose;
  }
  /// Makes all waiting calls check their conditions.
  void wake() const;

  // ---- the force ---------------------------------------------------------------------------------------------

  /// From this call on, losses of the force are reported to this program.
  void use_force();
  /// Called when this program switches the force on, or accepts that the force is off.
  void forget_lost_force();
  /// Called when this program switches the force off.
  void expect_force_off();
  /// Throws ForceLost after an unexpected loss of the force, until the force is on again or the loss was accepted.
  void require_force() const;
  /// uses_force() returns whether this program uses forces. had_force() returns whether its force was on since the link
  /// was opened.
  bool uses_force() const;
  bool had_force() const;

  /// Counts lost links, silences and lost forces. Each of these events stops the running servo.
  std::uint64_t interruptions() const;
  /// Waits until `condition` is true and returns the newest pose. Throws the newest loss if interruptions() has changed
  /// from `known`. Only for servos. In lock step, board time stops until the servo waits again or ends its answer.
  template <class Condition>
  inkwell_pose wait_uninterrupted(std::uint64_t known, Condition condition) const {
    const std::function<bool()> is_over = [&] { return interruptions_ != known || condition(seen_.pose); };
    std::unique_lock lock(mutex_);
    const inkwell_pose pose = wait(lock, is_over, forever_s, Turns::Answer::servo);
    if (interruptions_ != known) std::rethrow_exception(interruption_);
    return pose;
  }

  // ---- lock step ---------------------------------------------------------------------------------------------

  bool is_in_lock_step() const { return turn_.has_value(); }
  /// Calls `part` in each turn until `part` is removed. Only in lock step.
  void add(TurnPart& part);
  void remove(TurnPart& part);
  /// Marks that a thread answers a pose, so that board time waits for the thread. Has no effect outside lock step.
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

  /// Registers a waiter until the call returns or its thread is canceled. Requires the mutex.
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
  // The functions below require the mutex.
  void begin_waiting(Waiter& waiter) const;
  void end_waiting(const Waiter& waiter) const;
  enum class Waiting : std::uint8_t { servos, others, all };
  void release(Waiting which) const;
  void note(const inkwell_pose& pose, bool is_referenced);
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
