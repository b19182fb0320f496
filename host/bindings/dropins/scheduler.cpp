#include "host/bindings/dropins/scheduler.hpp"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <utility>

#include "host/client/process/cancellation.hpp"

namespace inkwell::dropins {
namespace {

using Clock = std::chrono::steady_clock;

constexpr unsigned long pose_rate_Hz = 1000;
constexpr std::size_t tasks_maximum = 1024;
/// Some programs store handles in signed 32-bit integers.
constexpr TaskHandle handle_maximum = 0x7FFFFFFF;
constexpr TaskHandle no_task = 0;
/// Nice value of the servo thread.
constexpr int precedence = -10;

}  // namespace

Scheduler::Scheduler(Pace pace, std::function<void()> end_tick)
    : pace_(std::move(pace)), end_tick_(std::move(end_tick)) {}

// ---- start, stop -------------------------------------------------------------------------------------------

void Scheduler::start() {
  std::unique_lock lock(mutex_);
  if (runs_ && !ends_) return;
  if (is_servo_thread()) {  // the scheduler was stopped in this tick
    ends_ = false;
    return;
  }
  {
    const process::CancellationPoint point;
    changed_.wait(lock, [this] { return !runs_; });
  }
  if (thread_.joinable()) thread_.join();
  ends_ = false;
  thread_ = std::thread([this] { loop(); });
  runs_ = true;
}

bool Scheduler::stop(std::chrono::milliseconds limit) {
  std::unique_lock lock(mutex_);
  if (!runs_) return true;
  ends_ = true;
  changed_.notify_all();
  if (is_servo_thread()) return true;
  {
    const process::CancellationPoint point;
    if (!changed_.wait_for(lock, limit, [this] { return !runs_; })) return false;
  }
  std::thread ended = std::move(thread_);
  lock.unlock();
  if (ended.joinable()) ended.join();
  return true;
}

bool Scheduler::runs() const {
  const std::lock_guard lock(mutex_);
  return runs_ && !ends_;
}

void Scheduler::loop() {
  process::never_cancel_this_thread();
  setpriority(PRIO_PROCESS, static_cast<id_t>(gettid()), precedence);
  servo_thread_id_ = std::this_thread::get_id();
  const auto ends = [this] {
    const std::lock_guard lock(mutex_);
    return ends_;
  };
  while (!ends()) {
    std::uint32_t poses = 1;
    {
      const std::lock_guard lock(mutex_);
      poses = poses_in_tick_;
    }
    const double period_s = pace_(poses, ends);
    measured_rate_Hz_ = period_s > 0.0 ? 1.0 / period_s : 0.0;
    if (!ends() && !tick()) return;
  }
  servo_thread_id_ = std::thread::id();
  const std::lock_guard lock(mutex_);
  runs_ = false;
  changed_.notify_all();
}

bool Scheduler::tick() {
  tick_began_ = Clock::now();
  ++ticks_;
  std::unique_lock lock(mutex_);
  for (const auto& task : Tasks(tasks_)) {
    if (find(task->handle) == tasks_.end()) continue;  // an earlier callback has unscheduled it
    called_ = task->handle;
    lock.unlock();
    const bool goes_on = task->callback(task->user) == callback_continue;
    if (!origin_.is_here()) return false;
    lock.lock();
    called_ = no_task;
    if (const auto found = find(task->handle); !goes_on && found != tasks_.end()) tasks_.erase(found);
    changed_.notify_all();
  }
  lock.unlock();
  end_tick_();
  return true;
}

// ---- rate, time --------------------------------------------------------------------------------------------

bool Scheduler::set_rate(unsigned long rate_Hz) {
  if (rate_Hz != pose_rate_Hz && rate_Hz != pose_rate_Hz / 2) return false;
  const std::lock_guard lock(mutex_);
  poses_in_tick_ = static_cast<std::uint32_t>(pose_rate_Hz / rate_Hz);
  return true;
}

int Scheduler::rate_Hz() const {
  const std::lock_guard lock(mutex_);
  return static_cast<int>(pose_rate_Hz / poses_in_tick_);
}

double Scheduler::measured_rate_Hz() const {
  const double measured_Hz = measured_rate_Hz_;
  return measured_Hz > 0.0 ? measured_Hz : rate_Hz();
}

double Scheduler::time_since_tick_s() const {
  if (ticks_ == 0) return 0.0;
  return std::chrono::duration<double>(Clock::now() - tick_began_.load()).count();
}

std::optional<std::uint64_t> Scheduler::tick_of_caller() const {
  return is_servo_thread() ? std::optional(ticks_.load()) : std::nullopt;
}

// ---- callbacks ---------------------------------------------------------------------------------------------

Scheduler::Tasks::const_iterator Scheduler::find(TaskHandle handle) const {
  return std::find_if(tasks_.begin(), tasks_.end(), [=](const auto& task) { return task->handle == handle; });
}

TaskHandle Scheduler::list(Callback callback, void* user, unsigned short priority) {
  if (tasks_.size() >= tasks_maximum) return invalid_handle;
  do last_handle_ = last_handle_ % handle_maximum + 1;
  while (find(last_handle_) != tasks_.end());
  const auto later =
      std::find_if(tasks_.begin(), tasks_.end(), [=](const auto& task) { return task->priority < priority; });
  tasks_.insert(later, std::make_shared<const Task>(Task{last_handle_, callback, user, priority}));
  return last_handle_;
}

TaskHandle Scheduler::add(Callback callback, void* user, unsigned short priority) {
  const bool is_done = is_servo_thread() && callback(user) != callback_continue;
  const std::lock_guard lock(mutex_);
  const auto handle = list(callback, user, priority);
  if (is_done && handle != invalid_handle) tasks_.erase(find(handle));
  return handle;
}

/// The destructor removes a task and waits until a running call of the task has returned. The data of the task may be
/// on the caller's stack.
class Scheduler::OffTheList {
 public:
  OffTheList(Scheduler& scheduler, std::unique_lock<std::mutex>& lock, TaskHandle handle)
      : scheduler_(scheduler), lock_(lock), handle_(handle) {}
  ~OffTheList() {
    if (const auto found = scheduler_.find(handle_); found != scheduler_.tasks_.end()) scheduler_.tasks_.erase(found);
    scheduler_.changed_.wait(lock_, [this] { return scheduler_.called_ != handle_; });
  }
  OffTheList(const OffTheList&) = delete;
  OffTheList& operator=(const OffTheList&) = delete;

 private:
  Scheduler& scheduler_;
  std::unique_lock<std::mutex>& lock_;
  const TaskHandle handle_;
};

bool Scheduler::run_until_done(Callback callback, void* user, unsigned short priority) {
  std::unique_lock lock(mutex_);
  if (!runs_ || ends_ || is_servo_thread()) {
    lock.unlock();
    const process::CancellationPoint as_the_caller_wants;
    callback(user);
    return true;
  }
  const auto handle = list(callback, user, priority);
  if (handle == invalid_handle) return false;
  const OffTheList at_the_end(*this, lock, handle);
  const process::CancellationPoint point;
  changed_.wait(lock, [&] { return find(handle) == tasks_.end() || (!runs_ && called_ != handle); });
  return true;
}

bool Scheduler::remove(TaskHandle handle) {
  std::unique_lock lock(mutex_);
  const auto found = find(handle);
  if (found == tasks_.end()) return false;
  tasks_.erase(found);
  changed_.notify_all();
  if (is_servo_thread()) return true;
  const process::CancellationPoint point;
  changed_.wait(lock, [&] { return called_ != handle; });
  return true;
}

bool Scheduler::is_listed(TaskHandle handle) const {
  const std::lock_guard lock(mutex_);
  return find(handle) != tasks_.end();
}

bool Scheduler::wait_until_done(TaskHandle handle) {
  std::unique_lock lock(mutex_);
  if (!is_servo_thread()) {
    const process::CancellationPoint point;
    changed_.wait(lock, [&] { return find(handle) == tasks_.end() || !runs_; });
  }
  return find(handle) == tasks_.end();
}

}  // namespace inkwell::dropins
