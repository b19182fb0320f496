#include "host/bindings/library/scope_stream.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "host/client/process/cancellation.hpp"

#include "host/bindings/library/errors.hpp"

namespace inkwell::library {
namespace {

using namespace std::chrono_literals;

/// The buffer stores the samples of five seconds.
constexpr std::size_t rows_maximum = std::size_t{5} * protocol::servo_rate_Hz;
/// Longest delay of the thread's exit.
constexpr auto scope_read_timeout = 20ms;

}  // namespace

ScopeStream::ScopeStream(device::Device& device, PoseFeed& poses, PoseReports& reports)
    : device_(device), poses_(poses), reports_(reports) {
  reports_.listen([this](const device::Pose& report) { take_report(report); });
  if (poses_.is_in_lock_step())
    poses_.add(*this);
  else
    thread_ = std::thread([this] { run(); });
}

ScopeStream::~ScopeStream() {
  reports_.listen({});
  {
    const std::lock_guard lock(mutex_);
    stops_ = true;
    changed_.notify_all();
  }
  poses_.remove(*this);
  if (thread_.joinable()) thread_.join();
}

void ScopeStream::select(const std::vector<protocol::Signal>& signals) {
  const std::lock_guard user(user_mutex_);
  if (recorder_) throw NotNow("A recording is running. Stop it before you select other signals.");
  if (signals.empty() && !clear_end_reason()) return;
  poses_.require_poses();
  device_.select_signals(signals);
  const std::lock_guard lock(mutex_);
  ++selection_;
  signals_ = signals;
  samples_.clear();
  rows_kept_ = 0;
  ended_by_.clear();
  changed_.notify_all();
}

bool ScopeStream::clear_end_reason() {
  const std::lock_guard lock(mutex_);
  if (signals_.empty()) ended_by_.clear();
  return !signals_.empty();
}

void ScopeStream::after_pose() {
  const std::uint64_t selection = selection_;
  try {
    while (auto samples = device_.read_scope(0ms)) keep(std::move(*samples));
  } catch (const Error& error) {
    end(selection, error.what());
  }
}

void ScopeStream::lose_link(const std::string& cause) { end(selection_, cause); }

void ScopeStream::run() {
  for (;;) {
    std::uint64_t selection = 0;
    {
      std::unique_lock lock(mutex_);
      changed_.wait(lock, [&] { return stops_ || !signals_.empty(); });
      if (stops_) return;
      selection = selection_;
    }
    try {
      if (auto samples = device_.read_scope(scope_read_timeout)) keep(std::move(*samples));
    } catch (const Error& error) {
      end(selection, error.what());
    }
  }
}

/// Ends a selection. A reconnected board has lost the selection of signals.
void ScopeStream::end(std::uint64_t selection, const std::string& cause) {
  const std::lock_guard lock(mutex_);
  if (selection != selection_ || signals_.empty()) return;
  ++selection_;
  signals_.clear();
  samples_.clear();
  rows_kept_ = 0;
  ended_by_ = cause;
  if (recorder_) {
    recorder_->note(device::event_now(device::EventKind::connection, cause, std::nullopt));
    recorder_->miss_end();
    feed_.emplace(*recorder_);
  }
  changed_.notify_all();
}

void ScopeStream::take_report(const device::Pose& report) {
  const std::lock_guard lock(mutex_);
  newest_period_ = report.time_periods;
  if (feed_) feed_->take(report);
}

void ScopeStream::keep(device::ScopeSamples samples) {
  const std::lock_guard lock(mutex_);
  if (samples.signals != signals_) return;
  if (recorder_) recorder_->push(samples);
  rows_kept_ += samples.count;
  samples_.push_back(std::move(samples));
  while (rows_kept_ > rows_maximum) {  // nobody reads: drop the oldest samples and count them as lost
    samples_[1].lost_before += samples_[0].lost_before + samples_[0].count;
    rows_kept_ -= samples_[0].count;
    samples_.pop_front();
  }
  changed_.notify_all();
}

void ScopeStream::wait_for_samples(std::unique_lock<std::mutex>& lock, double timeout_s) {
  const std::uint64_t selection = selection_;
  const auto is_over = [&] { return rows_kept_ > 0 || selection_ != selection; };
  if (!poses_.is_in_lock_step()) {
    constexpr double longest_s = 1e6;
    const process::CancellationPoint point;
    changed_.wait_for(lock, std::chrono::duration<double>(std::min(timeout_s, longest_s)),
                      [&] { return stops_ || is_over(); });
    return;
  }
  lock.unlock();
  poses_.wait([&](const auto&, Loss) { return is_over(); }, timeout_s);
  lock.lock();
}

std::optional<device::ScopeSamples> ScopeStream::read(double timeout_s, std::size_t capacity) {
  poses_.require_link();
  std::unique_lock lock(mutex_);
  if (signals_.empty() && !ended_by_.empty())
    throw device::Disconnected(fmt::format("{} Then select the signals again.", ended_by_));
  if (signals_.empty()) throw NotNow("No signals are selected. Select some first.");
  wait_for_samples(lock, checked_timeout_s(timeout_s));
  if (signals_.empty() && !ended_by_.empty()) throw device::Disconnected(ended_by_);
  if (samples_.empty() || capacity == 0) return std::nullopt;
  device::ScopeSamples& oldest = samples_.front();
  device::ScopeSamples taken;
  if (oldest.count <= capacity) {
    taken = std::move(oldest);
    samples_.pop_front();
  } else {
    taken = oldest;
    const auto values = static_cast<std::ptrdiff_t>(capacity * signals_.size());
    taken.values.resize(static_cast<std::size_t>(values));
    taken.count = capacity;
    oldest.values.erase(oldest.values.begin(), oldest.values.begin() + values);
    oldest.first_period += static_cast<std::int64_t>(capacity);
    oldest.count -= capacity;
    oldest.lost_before = 0;
  }
  rows_kept_ -= taken.count;
  return taken;
}

void ScopeStream::start_recording(const std::string& path, const protocol::ParameterSet& parameters, bool is_simulation,
                                  const recording::Origin& origin) {
  const std::lock_guard user(user_mutex_);
  std::vector<protocol::Signal> signals;
  {
    const std::lock_guard lock(mutex_);
    signals = signals_;
  }
  poses_.require_poses();
  if (signals.empty()) throw NotNow("No signals are selected. Select the signals to record first.");
  if (recorder_) throw NotNow("A recording is already running. Stop it first.");
  auto recorder = std::make_unique<recording::Recorder>(
      path, recording::describe(device_.information(), parameters, signals, "", is_simulation, origin));
  const std::lock_guard lock(mutex_);
  recorder_ = std::move(recorder);
  feed_.emplace(*recorder_);
}

bool ScopeStream::is_recording() {
  const std::lock_guard lock(mutex_);
  return recorder_ != nullptr;
}

void ScopeStream::mark(const std::string& text) {
  const std::lock_guard lock(mutex_);
  if (!recorder_) throw NotNow("No recording is running, so nothing can be marked. Start a recording first.");
  recorder_->note(device::event_now(device::EventKind::mark, text, newest_period_));
}

void ScopeStream::note(const std::vector<device::Event>& events) {
  const std::lock_guard lock(mutex_);
  for (const auto& event : events)
    if (recorder_)
      recorder_->note({event.kind, event.text, event.clock_utc, event.at_periods.value_or(newest_period_)});
}

recording::RecorderStatus ScopeStream::stop_recording() {
  const std::lock_guard user(user_mutex_);
  if (!recorder_) throw NotNow("No recording is running. Start one first.");
  std::unique_ptr<recording::Recorder> finished;
  {
    const std::lock_guard lock(mutex_);
    feed_.reset();
    finished = std::move(recorder_);
  }
  auto status = finished->stop();
  if (!status.error.empty()) throw Error(status.error);
  return status;
}

}  // namespace inkwell::library
