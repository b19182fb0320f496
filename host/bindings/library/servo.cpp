#include "host/bindings/library/servo.hpp"

#include <cmath>
#include <utility>

#include "host/client/process/cancellation.hpp"

#include "host/bindings/library/errors.hpp"

namespace inkwell::library {

Servo::Servo(const PoseFeed& poses, Output output, std::function<void()> let_go, const PoseReports* reports)
    : poses_(poses), reports_(reports), output_(std::move(output)), let_go_(std::move(let_go)) {
  inherit_priority(mutex_);
  thread_ = std::thread([this] { run(); });
}

Servo::~Servo() {
  request_end();
  {
    const std::lock_guard lock(mutex_);
    closes_ = true;
    changed_.notify_all();
  }
  thread_.join();
}

void Servo::start(Function function) {
  const std::lock_guard lock(mutex_);
  if (runs_) throw NotNow("A servo is already running on this arm. Stop it first.");
  runs_ = true;
  ++started_;
  is_to_end_ = false;
  ended_by_ = nullptr;
  known_interruptions_ = poses_.interruptions();
  function_ = std::move(function);
  poses_.begin_answer(thread_.get_id(), Turns::Answer::servo);  // until the servo waits for its first pose
  changed_.notify_all();
}

void Servo::request_end() {
  is_to_end_ = true;
  poses_.wake();
  poses_.end_answer(thread_.get_id());  // a call that does not return must not prevent the board from removing the
                                        // force
}

void Servo::stop() {
  std::uint64_t meant = 0;
  {
    const std::lock_guard lock(mutex_);
    if (!runs_) return;
    meant = started_;
    is_to_end_ = true;
  }
  poses_.wake();
  if (is_caller()) return;
  std::unique_lock lock(mutex_);
  const process::CancellationPoint point;
  changed_.wait(lock, [&] { return !runs_ || started_ != meant; });
}

Servo::Losses Servo::losses() const {
  const std::lock_guard lock(mutex_);
  return losses_;
}

bool Servo::is_running() const {
  const std::lock_guard lock(mutex_);
  return runs_;
}

void Servo::throw_what_ended_it() const {
  std::exception_ptr ended_by;
  {
    const std::lock_guard lock(mutex_);
    ended_by = ended_by_;
  }
  if (ended_by) std::rethrow_exception(ended_by);
}

void Servo::run() {
  process::never_cancel_this_thread();
  for (;;) {
    Function function;
    std::uint64_t known_interruptions = 0;
    {
      std::unique_lock lock(mutex_);
      changed_.wait(lock, [&] { return closes_ || function_; });
      if (closes_) return;
      function = std::exchange(function_, nullptr);
      known_interruptions = known_interruptions_;
    }
    std::exception_ptr ended_by;
    try {
      call(function, known_interruptions);
    } catch (...) {  // loss of poses or force, another driver, or an exception of the function
      ended_by = std::current_exception();
    }
    if (!origin_.is_here()) return;
    let_go_();
    poses_.end_answer(thread_.get_id());
    const std::lock_guard lock(mutex_);
    runs_ = false;
    ended_by_ = ended_by;
    changed_.notify_all();
  }
}

void Servo::call(const Function& function, std::uint64_t known_interruptions) {
  std::uint32_t seen = poses_.last().pose.sequence;
  const auto count_lost = [this] { return reports_ == nullptr ? 0 : reports_->lost(); };
  std::uint64_t lost = count_lost();
  for (bool goes_on = true, is_first = true; goes_on; is_first = false) {
    const auto pose = poses_.wait_uninterrupted(
        known_interruptions, [&](const auto& newest) { return is_to_end_ || newest.sequence != seen; });
    if (is_to_end_) return;
    const std::uint64_t not_called = pose.sequence - seen - 1, now_lost = count_lost();
    const std::uint64_t lost_since = now_lost - std::exchange(lost, now_lost);
    seen = pose.sequence;
    double force_N[3]{};
    const auto begin = Clock::now();
    goes_on = function(pose, force_N);
    if (!origin_.is_here()) return;  // the function has forked, and this is the child
    const double call_s = std::chrono::duration<double>(Clock::now() - begin).count();
    {
      const std::lock_guard lock(mutex_);
      if (!is_first && not_called > lost_since) losses_.poses_missed += not_called - lost_since;
      losses_.slow_calls += call_s > 1.0 / protocol::pose_rate_Hz;
      losses_.longest_call_s = std::max(losses_.longest_call_s, call_s);
    }
    // A value that is not finite becomes 0, because the previous force would otherwise remain active.
    for (double& value : force_N)
      if (!std::isfinite(value)) value = 0.0;
    output_(force_N, seen);
  }
}

}  // namespace inkwell::library
