#include "pose_feed.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include <device/fault_text.hpp>

#include "errors.hpp"

namespace inkwell::library {
namespace {

constexpr char lost_with_the_link[] =
    "The link to the arm was lost, and the force with it. Switch the force on again when the arm is back.";

std::string why_off(const inkwell_pose& pose) {
  switch (pose.state) {
    case INKWELL_FAULT:
      return fmt::format("A fault switched the force off. {}",
                         device::fault_line(static_cast<protocol::Fault>(pose.fault)));
    case INKWELL_STARTING:
      return "The force is off, because the board restarted or tests itself. Switch it on again when the arm is ready.";
    case INKWELL_UNREFERENCED:
      return "The force is off, because the arm no longer knows where it is. Put the stylus into the inkwell once, "
             "then "
             "switch the force on again.";
    default: return "Another program switched the force off. Switch it on again to continue.";
  }
}

}  // namespace

double seconds_from(double timeout_s) {
  if (std::isnan(timeout_s)) throw BadArgument("The time-out is not a number. Give seconds, from 0 on.");
  return std::clamp(timeout_s, 0.0, 1e6);
}

Clock::time_point in(double seconds) {
  return Clock::now() +
         std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds_from(seconds)));
}

// ---- for the thread that reads the poses -------------------------------------------------------------------

void PoseFeed::publish(const inkwell_pose& pose, bool is_referenced) {
  const std::lock_guard lock(mutex_);
  const bool is_on = pose.state == INKWELL_ACTIVE;
  const bool is_first = loss_ == Loss::link;  // of a new link: what was before it is no change
  const bool was_on = is_first ? is_on : seen_.pose.state == INKWELL_ACTIVE;
  if (is_first) had_force_ = false;
  if (was_on && !is_on && !(expects_force_off_ && pose.state == INKWELL_READY)) lose_force(why_off(pose));
  if (is_on && !was_on) force_lost_.reset();
  if (!is_on) expects_force_off_ = false;
  had_force_ = had_force_ || (is_on && uses_force_);
  loss_ = Loss::none;
  seen_ = {pose, is_referenced};
  changed_.notify_all();
}

void PoseFeed::lose(Loss kind, const std::string& cause) {
  const std::lock_guard lock(mutex_);
  const auto before = std::exchange(loss_, kind);
  cause_ = cause;
  if (before == Loss::none) interrupt(std::make_exception_ptr(device::Disconnected(cause)));
  if (kind == Loss::link && before != Loss::link && seen_.pose.state == INKWELL_ACTIVE && uses_force_)
    force_lost_ = lost_with_the_link;
  changed_.notify_all();
}

void PoseFeed::lose_claim(const std::string& cause) {
  const std::lock_guard lock(mutex_);
  lose_force(cause);
  changed_.notify_all();
}

// ---- poses -------------------------------------------------------------------------------------------------

PoseFeed::Seen PoseFeed::last() const {
  const std::lock_guard lock(mutex_);
  return seen_;
}

Loss PoseFeed::loss() const {
  const std::lock_guard lock(mutex_);
  return loss_;
}

void PoseFeed::require_poses(const std::unique_lock<std::mutex>&) const {
  if (loss_ != Loss::none) throw device::Disconnected(cause_);
}

void PoseFeed::require_link(const std::unique_lock<std::mutex>&) const {
  if (loss_ == Loss::link) throw device::Disconnected(cause_);
}

void PoseFeed::require_poses() const { require_poses(std::unique_lock(mutex_)); }

void PoseFeed::require_link() const { require_link(std::unique_lock(mutex_)); }

void PoseFeed::wake() const {
  const std::lock_guard lock(mutex_);
  changed_.notify_all();
}

// ---- the force ---------------------------------------------------------------------------------------------

void PoseFeed::use_force() {
  const std::lock_guard lock(mutex_);
  uses_force_ = true;
}

void PoseFeed::forget_lost_force() {
  const std::lock_guard lock(mutex_);
  force_lost_.reset();
  expects_force_off_ = false;
}

void PoseFeed::expect_force_off() {
  const std::lock_guard lock(mutex_);
  force_lost_.reset();
  expects_force_off_ = true;
}

void PoseFeed::require_force() const {
  const std::lock_guard lock(mutex_);
  if (force_lost_) throw ForceLost(*force_lost_);
}

bool PoseFeed::uses_force() const {
  const std::lock_guard lock(mutex_);
  return uses_force_;
}

bool PoseFeed::had_force() const {
  const std::lock_guard lock(mutex_);
  return had_force_;
}

std::uint64_t PoseFeed::interruptions() const {
  const std::lock_guard lock(mutex_);
  return interruptions_;
}

void PoseFeed::interrupt(std::exception_ptr by) {
  ++interruptions_;
  interruption_ = std::move(by);
}

void PoseFeed::lose_force(const std::string& cause) {
  if (!uses_force_) return;
  force_lost_ = cause;
  interrupt(std::make_exception_ptr(ForceLost(cause)));
}

}  // namespace inkwell::library
