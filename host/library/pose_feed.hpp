// The newest pose for every thread that wants it, and the losses that all of them hear of: of the poses, of the link,
// and of the force.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <exception>
#include <mutex>
#include <optional>
#include <string>

#include <inkwell/inkwell.h>
#include <process/cancellation.hpp>

namespace inkwell::library {

using Clock = std::chrono::steady_clock;

/// A time-out as a caller gave it, within bounds. Throws BadArgument if it is not a number.
double seconds_from(double timeout_s);
/// So many seconds from now. Throws BadArgument for what is no number.
Clock::time_point in(double seconds);

/// Why no poses come.
enum class Loss : std::uint8_t {
  none,     ///< they come
  silence,  ///< the link is there, but the board sends none
  link,     ///< the link is gone, and the connection looks for the board
};

class PoseFeed {
 public:
  // ---- for the thread that reads the poses ---------------------------------------------------------------------

  /// Ends a loss.
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

  /// The newest pose, once `condition(pose, loss)` holds or the time is over. Throws Disconnected while the link is
  /// gone; a silence may end in time.
  template <class Condition>
  inkwell_pose wait(Condition condition, Clock::time_point give_up_at = Clock::time_point::max()) const {
    std::unique_lock lock(mutex_);
    const process::CancellationPoint point;
    changed_.wait_until(lock, give_up_at, [&] { return loss_ == Loss::link || condition(seen_.pose, loss_); });
    require_link(lock);
    return seen_.pose;
  }
  /// Lets those who wait look at their conditions again.
  void wake() const;

  // ---- the force ---------------------------------------------------------------------------------------------

  /// This program gives forces from now on, so that it is told when they are lost.
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
  /// The newest pose, once it fulfils the condition. Throws the newest loss if there were other ones than `known`.
  template <class Condition>
  inkwell_pose wait_uninterrupted(std::uint64_t known, Condition condition) const {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return interruptions_ != known || condition(seen_.pose); });
    if (interruptions_ != known) std::rethrow_exception(interruption_);
    return seen_.pose;
  }

 private:
  void require_link(const std::unique_lock<std::mutex>& lock) const;
  void require_poses(const std::unique_lock<std::mutex>& lock) const;
  void interrupt(std::exception_ptr by);
  void lose_force(const std::string& cause);

  mutable std::mutex mutex_;
  mutable std::condition_variable changed_;
  Seen seen_{};
  Loss loss_ = Loss::none;
  std::string cause_;  ///< of the loss
  bool uses_force_ = false, had_force_ = false, expects_force_off_ = false;
  std::optional<std::string> force_lost_;
  std::uint64_t interruptions_ = 0;
  std::exception_ptr interruption_;  ///< the newest one
};

}  // namespace inkwell::library
