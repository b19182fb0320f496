// The newest pose for every thread that wants it, and the losses that all of them hear of: of the poses, of the link,
// and of the force.
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
#include <device/transport.hpp>
#include <process/cancellation.hpp>

#include "turns.hpp"

namespace inkwell::library {

using Clock = std::chrono::steady_clock;

/// No time-out.
inline constexpr double forever_s = std::numeric_limits<double>::infinity();

/// The time-out of a call, from 0 on. Throws BadArgument if it is not a number.
double checked_timeout_s(double seconds);

/// Why no poses come.
enum class Loss : std::uint8_t {
  none,     ///< they come
  silence,  ///< the link is there, but the board sends none
  link,     ///< the link is gone, and the connection looks for the board
};

/// The work of a part of the arm in the thread that reads poses, where the board is in lock step.
class TurnPart {
 public:
  virtual ~TurnPart() = default;
  /// Board time does not pass now, and passes after this.
  virtual void before_pose() {}
  /// The pose has come, and everything that the board sent before it.
  virtual void after_pose() {}
  /// The link is lost. `cause` is a sentence.
  virtual void lose_link([[maybe_unused]] const std::string& cause) {}
};

class PoseFeed final : public device::LockStep {
 public:
  // ---- for the thread that reads the poses ---------------------------------------------------------------------

  /// From now on poses come in these turns. `is_stepped`: board time passes only while a call waits, and until
  /// let_program_decide().
  void take_turns(std::shared_ptr<Turns> turns, bool is_stepped);
  /// The program has its arm, and decides from here on when time passes. To be repeated after a lost link.
  void let_program_decide();
  /// Waits until the next pose may be requested: immediately, unless the board is in lock step. False if the arm
  /// closes.
  bool begin_turn();
  /// The arm closes: begin_turn() does not wait any more.
  void leave_turns();

  /// Ends a loss. In lock step it returns once servos have answered the pose and the calls that it ends are released.
  void publish(const inkwell_pose& pose, bool is_referenced);
  /// `cause` is a sentence that says what to do. The newest one counts.
  void lose(Loss kind, const std::string& cause);
  /// This program drives the arm no longer, against its will.
  void lose_claim(const std::string& cause);

  // ---- poses ---------------------------------------------------------------------------------------------------

  struct Seen {
    inkwell_pose pose{};
    bool is_referenced = false;  ///< whether the arm knows its place
  };
  /// The last one that came, during a loss too.
  Seen last() const;
  Loss loss() const;
  /// Hands the last one to `take`, then throws Disconnected if that was during a loss.
  template <class Take>
  void read(Take take) const {
    const std::unique_lock lock(mutex_);
    take(seen_);
    require_poses(lock);
  }
  /// Throws Disconnected during a loss.
  void require_poses() const;
  /// Throws Disconnected while the link is gone.
  void require_link() const;

  /// The newest pose, once `condition(pose, loss)` holds, or once this much board time has passed, or if no pose came
  /// for as long. Throws Disconnected while the link is gone; a silence may end in time. `answer` is what the thread
  /// does with the pose.
  template <class Condition>
  inkwell_pose wait(Condition condition, double timeout_s = forever_s,
                    Turns::Answer answer = Turns::Answer::none) const {
    bool is_lost = false;  // the link may be there again before this thread runs
    const std::function<bool()> is_over = [&] {
      is_lost = loss_ == Loss::link;
      return is_lost || condition(seen_.pose, loss_);
    };
    std::unique_lock lock(mutex_);
    const inkwell_pose pose = wait(lock, is_over, timeout_s, answer);
    if (is_lost) throw_loss(lock);
    return pose;
  }
  /// Lets those who wait look at their conditions again.
  void wake() const;

  // ---- the force ---------------------------------------------------------------------------------------------

  /// This program sets forces from now on, so losses of the force are reported to it.
  void use_force();
  /// This program switches the force on, or accepts that it is off.
  void forget_lost_force();
  /// This program switches the force off.
  void expect_force_off();
  /// Throws ForceLost once the force went off against the program's will, until it is on again or forgotten.
  void require_force() const;
  /// Whether this program uses the force, and had it since the link was made.
  bool uses_force() const;
  bool had_force() const;

  /// Losses of the poses or of the force so far. Each ends the servo that runs.
  std::uint64_t interruptions() const;
  /// The newest pose, once it fulfils the condition. Throws the newest loss if there were other ones than `known`. For
  /// a servo: board time does not pass until it waits again, or ends its answer.
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
  /// Is called in each turn until it is removed. Only in lock step.
  void add(TurnPart& part);
  void remove(TurnPart& part);
  /// This thread, or another one, answers a pose: board time waits for it. Without effect unless in lock step.
  void begin_answer(std::thread::id thread, Turns::Answer answer) const;
  void end_answer(std::thread::id thread) const;

  bool is_in_step() const override;
  bool wait(const std::function<bool()>& is_over, std::chrono::milliseconds patience) override;

 private:
  struct Waiter {
    const std::function<bool()>& is_over;
    double give_up_s;  ///< board time
    Turns::Answer answer;
    std::thread::id thread;
    bool is_in_servo = false;               ///< the servo waits for something else before it answers
    std::optional<inkwell_pose> pose = {};  ///< with which the wait is over
  };

  /// A waiter in the list, until the call returns or its thread is cancelled. With the mutex held.
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
  // With the mutex held:
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
  std::string cause_;  ///< of the loss
  bool uses_force_ = false, had_force_ = false, expects_force_off_ = false;
  std::optional<std::string> force_lost_;
  std::uint64_t interruptions_ = 0;
  std::exception_ptr interruption_;  ///< the newest one

  // Set before any other part is made.
  std::shared_ptr<Turns> turns_;      ///< null: poses come by themselves
  std::optional<Turns::Board> turn_;  ///< likewise
  bool is_stepped_ = false;
  std::thread::id reader_;  ///< in lock step, from its first turn on
  bool is_asked_ = false;   ///< a pose; used by the reader only
  std::mutex parts_mutex_;
  std::vector<TurnPart*> parts_;
};

}  // namespace inkwell::library
