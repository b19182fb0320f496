#include "arm.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <utility>

#include <fmt/format.h>

#include <device/fault_text.hpp>

namespace inkwell::library {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;
using protocol::Command;
using protocol::State;

constexpr double first_pose_limit_s = 60.0;
constexpr auto read_timeout = 2ms;
/// Until a device that was asked for its force is asked again.
constexpr auto ask_again = 100ms;
/// Samples of the scope that nobody has read: five seconds.
constexpr std::size_t rows_maximum = 5 * protocol::servo_rate_Hz;
/// Until the fading of this program's last force has begun.
constexpr auto farewell = 5ms;

Clock::time_point in(double seconds) {
  if (std::isnan(seconds)) throw BadArgument("The time-out is not a number. Give seconds, from 0 on.");
  return Clock::now() +
         std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(std::clamp(seconds, 0.0, 1e6)));
}

/// Milliseconds from one force of the program to the next, as it sends them.
class Interval {
 public:
  int next() {
    const auto now = Clock::now();
    const double passed_ms = std::chrono::duration<double, std::milli>(now - before_).count();
    before_ = now;
    // A pause is not the program's pace; a single late one is not either.
    if (passed_ms < protocol::force_interval_maximum_ms) smoothed_ms_ += 0.2 * (passed_ms - smoothed_ms_);
    return std::clamp(static_cast<int>(std::lround(smoothed_ms_)), 1, int{protocol::force_interval_maximum_ms});
  }

 private:
  Clock::time_point before_{};
  double smoothed_ms_ = 1.0;
};

}  // namespace

Arm::Arm(const std::string& address) {
  std::promise<void> opened;
  auto is_open = opened.get_future();
  // A board of its own ends with the thread that made it (device::VirtualBoard).
  report_thread_ = std::thread([this, address, promise = std::move(opened)]() mutable {
    try {
      open(address);
    } catch (...) {
      promise.set_exception(std::current_exception());
      device_.reset();
      board_.reset();
      return;
    }
    report_loop(std::move(promise));
    control_.reset();
    board_.reset();
  });
  try {
    is_open.get();
  } catch (...) {
    report_thread_.join();
    throw;
  }
  output_thread_ = std::thread([this] { output_loop(); });
  scope_thread_ = std::thread([this] { scope_loop(); });
}

Arm::~Arm() {
  stop_servo();
  bool drove = false;
  {
    const std::lock_guard lock(mutex_);
    drove = claim_.has_value() && !lost_;
  }
  if (drove) {
    try {
      device_->send_force({.mode = protocol::ForceMode::none});
      device_->place_shapes({});
      device_->send(Command::disable_force);
      std::this_thread::sleep_for(farewell);
    } catch (const Error&) {  // it is gone already, and its force with it
    }
  }
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
    pose_changed_.notify_all();
    force_changed_.notify_all();
    scope_changed_.notify_all();
  }
  output_thread_.join();
  scope_thread_.join();
  report_thread_.join();
}

void Arm::open(const std::string& address) {
  device::OpenArm opened = open_arm(address);
  board_ = std::move(opened.board);
  control_ = std::move(opened.control);
  device_ = std::move(opened.device);
  endpoint_ = opened.endpoint;
  reader_.emplace(device_->parameters());
}

// ---- the report thread -------------------------------------------------------------------------------------

void Arm::report_loop(std::promise<void> opened) {
  bool is_open = false;
  const auto give_up_at = in(first_pose_limit_s);
  const auto stops = [this] {
    const std::lock_guard lock(mutex_);
    return stopping_;
  };
  while (!stops()) {
    try {
      if (const auto report = device_->read_pose(read_timeout)) {
        const std::lock_guard lock(mutex_);
        newest_ = {reader_->read(*report), true};
        pose_changed_.notify_all();
        // A board of its own has its stylus in the inkwell until the program moves the hand.
        const bool knows_where_it_is =
            newest_.pose.state != INKWELL_STARTING && newest_.pose.state != INKWELL_UNREFERENCED;
        if (!is_open && (!board_ || knows_where_it_is)) {
          is_open = true;
          opened.set_value();
        }
      }
      device_->keep_alive();
      if (!is_open && Clock::now() > give_up_at)
        throw TimedOut("The device sends no poses. Reset the board, or let a paused virtual board run.");
    } catch (const Error& error) {
      if (!is_open) return opened.set_exception(std::current_exception());
      return lose(error.what());
    }
  }
}

void Arm::lose(const std::string& reason) {
  const std::lock_guard lock(mutex_);
  if (!lost_) lost_ = reason;
  pose_changed_.notify_all();
  force_changed_.notify_all();
  scope_changed_.notify_all();
}

void Arm::require_connected(const std::unique_lock<std::mutex>&) const {
  if (lost_) throw device::Disconnected(*lost_);
}

device::Device& Arm::device() {
  require_connected(std::unique_lock(mutex_));
  return *device_;
}

device::ControlClient& Arm::virtual_hand() {
  if (!control_) throw NotNow("Only an arm that was opened as \"virtual\" has a simulated hand.");
  require_connected(std::unique_lock(mutex_));
  return *control_;
}

inkwell_pose Arm::pose() const {
  const std::unique_lock lock(mutex_);
  require_connected(lock);
  return newest_.pose;
}

inkwell_pose Arm::wait_for_pose(double timeout_s, std::optional<std::uint32_t> after_sequence) {
  std::unique_lock lock(mutex_);
  const std::uint32_t seen = after_sequence.value_or(newest_.pose.sequence);
  const bool came =
      pose_changed_.wait_until(lock, in(timeout_s), [&] { return lost_ || newest_.pose.sequence != seen; });
  require_connected(lock);
  if (!came) throw TimedOut("No pose came in time. Reset the board, or let a paused virtual board run.");
  return newest_.pose;
}

control::Pose Arm::forward_kinematics(const control::Triple& joint_rad) const {
  const std::lock_guard lock(mutex_);
  return reader_->forward_kinematics(joint_rad);
}

// ---- force -------------------------------------------------------------------------------------------------

void Arm::enable_force(double timeout_s) {
  const auto give_up_at = in(timeout_s);
  const auto refuse_in_fault = [](const inkwell_pose& now) {
    if (now.state == INKWELL_FAULT) throw NotNow(device::fault_line(static_cast<protocol::Fault>(now.fault)));
  };
  refuse_in_fault(pose());
  for (;;) {
    // A device that does not know yet where it is forgets that it was asked.
    device().send(Command::enable_force);
    std::unique_lock lock(mutex_);
    pose_changed_.wait_until(lock, std::min(give_up_at, Clock::now() + ask_again), [&] {
      return lost_ || newest_.pose.state == INKWELL_ACTIVE || newest_.pose.state == INKWELL_FAULT;
    });
    require_connected(lock);
    const inkwell_pose& now = newest_.pose;
    if (now.state == INKWELL_ACTIVE) return;
    refuse_in_fault(now);
    if (Clock::now() < give_up_at) continue;
    if (now.state == INKWELL_UNREFERENCED)
      throw NotNow("The arm does not know where it is. Put the stylus into the inkwell once, then try again.");
    throw TimedOut("The device did not switch the force on in time. Try again.");
  }
}

void Arm::disable_force() { device().send(Command::disable_force); }

void Arm::set_force_mode(protocol::ForceMode mode) {
  const std::lock_guard lock(mutex_);
  mode_ = mode;
}

void Arm::claim() {
  const std::lock_guard lock(mutex_);
  if (claim_) return;
  // Virtual boards that started with the same seed have the same number.
  const bool own_server = endpoint_.kind == device::Endpoint::Kind::usbip;
  claim_.emplace(own_server ? fmt::format("{}-{}", endpoint_.serial_number, endpoint_.port) : endpoint_.serial_number);
}

void Arm::set_force(const double (&force_N)[3]) {
  claim();
  device::ForceRequest request;
  for (std::size_t i = 0; i < 3; ++i) {
    // What float can not hold is as huge as the largest that it can: the board bounds it.
    constexpr double largest_N = 1e30;
    if (std::isnan(force_N[i])) throw BadArgument("The force is not a number on one axis. Give finite numbers.");
    request.force_N[i] = static_cast<float>(std::clamp(force_N[i], -largest_N, largest_N));
  }
  const std::unique_lock lock(mutex_);
  require_connected(lock);
  request.mode = mode_;
  next_force_ = request;
  force_changed_.notify_one();
}

/// Sends the newest force, at most one in a millisecond: the USB takes no more, and an old one is worth nothing.
void Arm::output_loop() {
  Interval interval;
  for (;;) {
    device::ForceRequest request;
    {
      std::unique_lock lock(mutex_);
      force_changed_.wait(lock, [&] { return stopping_ || lost_ || next_force_; });
      if (stopping_ || lost_) return;
      request = *std::exchange(next_force_, std::nullopt);
    }
    request.interval_ms = interval.next();
    try {
      device_->send_force(request);
    } catch (const Error& error) {
      return lose(error.what());
    }
  }
}

void Arm::place_shapes(const device::Shapes& shapes) {
  claim();
  device().place_shapes(shapes);
}

// ---- the servo ---------------------------------------------------------------------------------------------

void Arm::start_servo(Servo servo) {
  claim();
  {
    const std::unique_lock lock(mutex_);
    require_connected(lock);
    if (servo_runs_) throw NotNow("A servo runs on this arm already. Stop it first.");
    servo_runs_ = true;
    servo_ends_ = false;
  }
  if (servo_thread_.joinable()) servo_thread_.join();  // of one that ended by itself
  servo_thread_ = std::thread([this, servo = std::move(servo)]() mutable { servo_loop(std::move(servo)); });
}

void Arm::servo_loop(Servo servo) {
  std::unique_lock lock(mutex_);
  servo_thread_id_ = std::this_thread::get_id();
  std::uint32_t seen = newest_.pose.sequence;
  for (;;) {
    pose_changed_.wait(lock, [&] { return stopping_ || lost_ || servo_ends_ || newest_.pose.sequence != seen; });
    if (stopping_ || lost_ || servo_ends_) break;
    const inkwell_pose pose = newest_.pose;
    seen = pose.sequence;
    lock.unlock();
    double force_N[3]{};
    const bool goes_on = servo(pose, force_N);
    // A force that is no number is none; the device would refuse it and let the one before expire.
    for (double& value : force_N)
      if (std::isnan(value)) value = 0.0;
    try {
      set_force(force_N);
    } catch (const Error&) {  // the loop ends for the same reason
    }
    lock.lock();
    if (!goes_on) break;
  }
  if (!lost_) next_force_ = device::ForceRequest{.mode = protocol::ForceMode::none};
  force_changed_.notify_one();
  servo_runs_ = false;
  servo_thread_id_ = {};
  servo_changed_.notify_all();
}

void Arm::stop_servo() {
  {
    std::unique_lock lock(mutex_);
    servo_ends_ = true;
    pose_changed_.notify_all();
    if (servo_thread_id_ == std::this_thread::get_id()) return;  // by the servo itself: it ends after this call
    servo_changed_.wait(lock, [&] { return !servo_runs_; });
  }
  if (servo_thread_.joinable()) servo_thread_.join();
}

bool Arm::servo_is_running() const {
  const std::lock_guard lock(mutex_);
  return servo_runs_;
}

// ---- parameters --------------------------------------------------------------------------------------------

void Arm::set_parameters(const std::vector<device::ParameterChange>& changes) {
  device().set_parameters(changes);
  // The arm's geometry may be among them, and the stylus's orientation follows from it.
  const auto parameters = device().parameters();
  const std::lock_guard lock(mutex_);
  reader_.emplace(parameters);
}

// ---- scope and recording -----------------------------------------------------------------------------------

void Arm::select_signals(const std::vector<protocol::Signal>& signals) {
  {
    const std::lock_guard lock(mutex_);
    if (recorder_) throw NotNow("A recording runs. Stop it before other signals are selected.");
  }
  device().select_signals(signals);
  const std::lock_guard lock(mutex_);
  signals_ = signals;
  samples_.clear();
  rows_kept_ = 0;
  scope_changed_.notify_all();
}

void Arm::scope_loop() {
  for (;;) {
    {
      std::unique_lock lock(mutex_);
      scope_changed_.wait(lock, [&] { return stopping_ || lost_ || !signals_.empty(); });
      if (stopping_ || lost_) return;
    }
    try {
      auto samples = device_->read_scope(20ms);
      if (!samples) continue;
      const std::lock_guard lock(mutex_);
      if (samples->signals != signals_) continue;
      if (recorder_) recorder_->push(*samples);
      rows_kept_ += samples->count;
      samples_.push_back(std::move(*samples));
      while (rows_kept_ > rows_maximum) {  // nobody reads: the oldest go, and are counted
        samples_[1].lost_before += samples_[0].lost_before + samples_[0].count;
        rows_kept_ -= samples_[0].count;
        samples_.erase(samples_.begin());
      }
      scope_changed_.notify_all();
    } catch (const Error& error) {
      return lose(error.what());
    }
  }
}

std::optional<device::ScopeSamples> Arm::read_scope(double timeout_s, std::size_t capacity) {
  std::unique_lock lock(mutex_);
  if (signals_.empty()) throw NotNow("No signals are selected. Select some first.");
  scope_changed_.wait_until(lock, in(timeout_s), [&] { return stopping_ || lost_ || !samples_.empty(); });
  require_connected(lock);
  if (samples_.empty() || capacity == 0) return std::nullopt;
  device::ScopeSamples& oldest = samples_.front();
  device::ScopeSamples taken = oldest;
  if (oldest.count <= capacity) {
    samples_.erase(samples_.begin());
  } else {
    const auto values = static_cast<std::ptrdiff_t>(capacity * signals_.size());
    taken.values.resize(static_cast<std::size_t>(values));
    taken.count = capacity;
    oldest.values.erase(oldest.values.begin(), oldest.values.begin() + values);
    oldest.first_period += static_cast<std::uint32_t>(capacity);
    oldest.count -= capacity;
    oldest.lost_before = 0;
  }
  rows_kept_ -= taken.count;
  return taken;
}

void Arm::start_recording(const std::string& path) {
  const auto information = device().information();
  const auto parameters = device().parameters();
  const std::lock_guard lock(mutex_);
  if (signals_.empty()) throw NotNow("No signals are selected. Select those to be recorded first.");
  if (recorder_) throw NotNow("A recording runs already. Stop it first.");
  recorder_ = std::make_unique<recording::Recorder>(
      path, recording::describe(information, parameters, signals_, "", endpoint_.is_virtual));
}

recording::RecorderStatus Arm::stop_recording() {
  std::unique_ptr<recording::Recorder> finished;
  {
    const std::lock_guard lock(mutex_);
    finished = std::move(recorder_);
  }
  if (!finished) throw NotNow("No recording runs.");
  const auto status = finished->stop();
  if (!status.error.empty()) throw Error(status.error);
  return status;
}

}  // namespace inkwell::library
