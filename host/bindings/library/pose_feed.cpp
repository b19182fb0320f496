#include "host/bindings/library/pose_feed.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "host/client/device/fault_text.hpp"

#include "host/bindings/library/errors.hpp"

namespace inkwell::library {
namespace {

/// A stepped program receives an error after a silence of this length. The limit is long, because a virtual board on a
/// busy computer is slow.
constexpr double stepped_silence_s = 2.0;

constexpr char lost_with_the_link[] =
    "The link to the arm was lost, and the force is off. Switch the force on again when the arm is connected.";

std::string why_off(const inkwell_pose& pose) {
  switch (pose.state) {
    case INKWELL_FAULT:
      return fmt::format("A fault switched the force off. {}",
                         device::fault_line(static_cast<protocol::Fault>(pose.fault)));
    case INKWELL_STARTING:
      return "The force is off because the board restarted or runs its self-test. Switch the force on again when the "
             "arm is ready.";
    case INKWELL_UNREFERENCED:
      return "The force is off because the encoders are no longer referenced. Put the stylus into the inkwell once, "
             "then switch the force on again.";
    default: return "Another program switched the force off. Switch the force on again to continue.";
  }
}

}  // namespace

double checked_timeout_s(double seconds) {
  if (std::isnan(seconds)) throw BadArgument("The time-out is not a number. Give a time of 0 s or more.");
  return std::max(seconds, 0.0);
}

// ---- pose thread --------------------------------------------------------------------------------------------

void PoseFeed::take_turns(std::shared_ptr<Turns> turns, bool is_stepped) {
  turns_ = std::move(turns);
  is_stepped_ = is_stepped;
  turn_.emplace(turns_, is_stepped);
}

void PoseFeed::let_program_decide() {
  if (turn_) turn_->let_program_decide();
}

bool PoseFeed::begin_turn() {
  if (!turn_ || is_requested_) return true;
  {
    const std::lock_guard lock(mutex_);
    reader_ = std::this_thread::get_id();
  }
  if (!turn_->begin()) return false;
  const std::lock_guard lock(parts_mutex_);
  for (TurnPart* part : parts_) part->before_pose();
  is_requested_ = true;
  return true;
}

void PoseFeed::leave_turns() {
  if (turn_) turn_->leave();
}

void PoseFeed::publish(const inkwell_pose& pose, bool is_referenced, const Motion& motion) {
  {
    const std::lock_guard lock(mutex_);
    note(pose, is_referenced, motion);
    if (!turn_) return release(Waiting::all);
  }
  is_requested_ = false;
  if (!turn_->meet()) return;
  {
    const std::lock_guard lock(mutex_);
    release(Waiting::servos);
  }
  if (!turn_->meet() || !turn_->wait_for_servos()) return;
  {
    const std::lock_guard lock(parts_mutex_);
    for (TurnPart* part : parts_) part->after_pose();
  }
  {
    const std::lock_guard lock(mutex_);
    release(Waiting::others);
  }
  turn_->end();
}

void PoseFeed::note(const inkwell_pose& pose, bool is_referenced, const Motion& motion) {
  const bool is_on = pose.state == INKWELL_ACTIVE;
  const bool is_first = loss_ == Loss::link;  // first pose of a new link: a difference from the old link is not a
                                              // change
  const bool was_on = is_first ? is_on : seen_.pose.state == INKWELL_ACTIVE;
  if (is_first) had_force_ = false;
  if (was_on && !is_on && !(expects_force_off_ && pose.state == INKWELL_READY)) lose_force(why_off(pose));
  if (is_on && !was_on) force_lost_.reset();
  if (!is_on) expects_force_off_ = false;
  had_force_ = had_force_ || (is_on && uses_force_);
  loss_ = Loss::none;
  seen_ = {pose, is_referenced, motion};
  ++poses_;
}

void PoseFeed::lose(Loss kind, const std::string& cause) {
  {
    const std::lock_guard lock(mutex_);
    note_loss(kind, cause);
    release(Waiting::all);
  }
  if (kind != Loss::link || !turn_) return;
  turn_->pause();
  is_requested_ = false;
  const std::lock_guard lock(parts_mutex_);
  for (TurnPart* part : parts_) part->lose_link(cause);
}

void PoseFeed::note_loss(Loss kind, const std::string& cause) {
  const auto before = std::exchange(loss_, kind);
  cause_ = cause;
  if (before == Loss::none) interrupt(std::make_exception_ptr(device::Disconnected(cause)));
  if (kind == Loss::link && before != Loss::link && seen_.pose.state == INKWELL_ACTIVE && uses_force_)
    force_lost_ = lost_with_the_link;
}

void PoseFeed::lose_claim(const std::string& cause) {
  const std::lock_guard lock(mutex_);
  lose_force(cause);
  release(Waiting::all);
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

void PoseFeed::throw_loss(const std::unique_lock<std::mutex>&) const { throw device::Disconnected(cause_); }

void PoseFeed::require_poses(const std::unique_lock<std::mutex>& lock) const {
  if (loss_ != Loss::none) throw_loss(lock);
}

void PoseFeed::require_link(const std::unique_lock<std::mutex>& lock) const {
  if (loss_ == Loss::link) throw_loss(lock);
}

void PoseFeed::require_poses() const { require_poses(std::unique_lock(mutex_)); }

void PoseFeed::require_link() const { require_link(std::unique_lock(mutex_)); }

// ---- waiting -----------------------------------------------------------------------------------------------

PoseFeed::WaitingCall::WaitingCall(const PoseFeed& feed, Waiter& waiter) : feed_(feed), waiter_(waiter) {
  feed_.waiters_.push_back(&waiter_);
  feed_.begin_waiting(waiter_);
}

PoseFeed::WaitingCall::~WaitingCall() {
  std::erase(feed_.waiters_, &waiter_);
  if (waiter_.pose) return;
  if (waiter_.answer == Turns::Answer::loop) waiter_.answer = Turns::Answer::none;
  feed_.end_waiting(waiter_);
}

void PoseFeed::begin_waiting(Waiter& waiter) const {
  if (!turns_) return;
  if (waiter.answer == Turns::Answer::servo)
    turns_->end_answer(waiter.thread);
  else
    waiter.is_in_servo = turns_->begin_waiting(waiter.thread) == Turns::Answer::servo;
}

void PoseFeed::end_waiting(const Waiter& waiter) const {
  if (!turns_) return;
  if (waiter.answer == Turns::Answer::servo)
    turns_->begin_answer(waiter.thread, waiter.answer);
  else
    turns_->end_waiting(waiter.thread, waiter.is_in_servo ? Turns::Answer::servo : waiter.answer);
}

void PoseFeed::release(Waiting which) const {
  for (Waiter* waiter : waiters_) {
    const bool is_servo = waiter->answer == Turns::Answer::servo;
    if (waiter->pose || (which == Waiting::servos && !is_servo) || (which == Waiting::others && is_servo)) continue;
    if (!waiter->is_over() && seen_.pose.time_s < waiter->deadline_s) continue;
    waiter->pose = seen_.pose;
    end_waiting(*waiter);
  }
  changed_.notify_all();
}

inkwell_pose PoseFeed::wait(std::unique_lock<std::mutex>& lock, const std::function<bool()>& is_over, double timeout_s,
                            Turns::Answer answer) const {
  const auto thread = std::this_thread::get_id();
  if (is_over()) {
    if (answer != Turns::Answer::none) begin_answer(thread, answer);
    return seen_.pose;
  }
  if (timeout_s <= 0) return seen_.pose;
  Waiter waiter{is_over, seen_.pose.time_s + timeout_s, answer, thread};
  const WaitingCall call(*this, waiter);
  constexpr double longest_s = 1e6;
  const std::chrono::duration<double> patience{
      std::min(is_stepped_ ? std::max(timeout_s, stepped_silence_s) : timeout_s, longest_s)};
  std::uint64_t heard = 0;
  const process::CancellationPoint point;
  do heard = poses_;
  while (!changed_.wait_for(lock, patience, [&] { return waiter.pose.has_value(); }) && poses_ != heard);
  return waiter.pose.value_or(seen_.pose);
}

void PoseFeed::wake() const {
  const std::lock_guard lock(mutex_);
  release(Waiting::all);
}

// ---- the force ---------------------------------------------------------------------------------------------

void PoseFeed::use_force() {
  const std::lock_guard lock(mutex_);
  uses_force_ = true;
}

void PoseFeed::stop_using_force() {
  const std::lock_guard lock(mutex_);
  uses_force_ = false;
  force_lost_.reset();
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

// ---- lock step ---------------------------------------------------------------------------------------------

void PoseFeed::add(TurnPart& part) {
  const std::lock_guard lock(parts_mutex_);
  parts_.push_back(&part);
}

void PoseFeed::remove(TurnPart& part) {
  const std::lock_guard lock(parts_mutex_);
  std::erase(parts_, &part);
}

void PoseFeed::begin_answer(std::thread::id thread, Turns::Answer answer) const {
  if (turns_) turns_->begin_answer(thread, answer);
}

void PoseFeed::end_answer(std::thread::id thread) const {
  if (turns_) turns_->end_answer(thread);
}

bool PoseFeed::is_in_step() const {
  const std::lock_guard lock(mutex_);
  return reader_ != std::thread::id{} && reader_ != std::this_thread::get_id() && loss_ != Loss::link;
}

bool PoseFeed::wait(const std::function<bool()>& is_over, std::chrono::milliseconds patience) {
  bool is_done = false;
  wait([&](const inkwell_pose&, Loss) { return is_done = is_over(); }, std::chrono::duration<double>(patience).count());
  return is_done;
}

}  // namespace inkwell::library
