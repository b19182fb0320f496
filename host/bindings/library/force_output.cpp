#include "host/bindings/library/force_output.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "host/bindings/library/errors.hpp"

namespace inkwell::library {
namespace {

/// Longest delay of stop() if the device accepts no force.
constexpr auto attention = std::chrono::milliseconds(20);

/// A program answers each pose if its newest force belongs to a pose of at most this age, in poses.
constexpr std::uint32_t answering_poses = 2;

}  // namespace

ForceOutput::ForceOutput(device::Device& device, PoseFeed& poses) : device_(device), poses_(poses) {
  inherit_priority(mutex_);
  if (poses_.is_in_lock_step())
    poses_.add(*this);
  else
    thread_ = std::thread([this] { run(); });
}

ForceOutput::~ForceOutput() { stop(); }

void ForceOutput::stop() {
  {
    const std::lock_guard lock(mutex_);
    stops_ = true;
    changed_.notify_one();
  }
  poses_.remove(*this);
  if (thread_.joinable()) thread_.join();
}

void ForceOutput::set_mode(protocol::ForceMode mode) {
  const std::lock_guard lock(mutex_);
  mode_ = mode;
}

void ForceOutput::send(const double (&force_N)[3], std::uint32_t pose_sequence) {
  device::ForceRequest request;
  request.pose_sequence = pose_sequence;
  for (std::size_t i = 0; i < 3; ++i) {
    // Values beyond the float range are clamped, and the board limits the force.
    constexpr double largest_N = 1e30;
    if (!std::isfinite(force_N[i]))
      throw BadArgument("The force is not a finite number on one axis. Give finite numbers.");
    request.force_N[i] = static_cast<float>(std::clamp(force_N[i], -largest_N, largest_N));
  }
  {
    const std::lock_guard lock(mutex_);
    request.mode = mode_;
    next_ = request;
  }
  changed_.notify_one();  // notified without the mutex, so that the thread does not wake only to wait for it
}

void ForceOutput::send_model(const device::LocalModel& model, std::uint32_t pose_sequence, double force_life_s) {
  {
    const std::lock_guard lock(mutex_);
    const bool is_answering = newest_.mode != protocol::ForceMode::none &&
                              pose_sequence - newest_.pose_sequence.value_or(0) <= answering_poses;
    model_is_due_ = !is_answering || model_.has_value();
    model_ = Model{model, pose_sequence, force_life_s};
    if (!has_report()) return;
  }
  changed_.notify_one();
}

void ForceOutput::let_go() {
  const std::lock_guard lock(mutex_);
  next_ = device::ForceRequest{.mode = protocol::ForceMode::none};
  changed_.notify_one();
}

void ForceOutput::before_pose() {
  {
    const std::lock_guard lock(mutex_);
    if (stops_ || (!next_ && !model_)) return;
  }
  send_next(std::chrono::milliseconds(0));
}

void ForceOutput::lose_link(const std::string&) { drop_force(); }

void ForceOutput::run() {
  while (wait_for_force()) send_next(attention);
}

void ForceOutput::send_next(std::chrono::milliseconds patience) {
  try {
    // USB carries one report per bus frame, so a queue of forces would never drain. While a report is pending, a newer
    // force replaces the force in `next_`.
    if (!device_.wait_until_written(patience)) return;
    std::optional<Model> model;
    device::ForceRequest request;
    {
      const std::lock_guard lock(mutex_);
      if (!next_ && !model_) return;  // another thread has dropped the report
      model = std::exchange(model_, std::nullopt);
      request = next_ ? take_force() : repeated_force(*model);
    }
    if (poses_.loss() != Loss::none) return;  // the force belongs to an older pose
    model ? device_.send_local_model(model->model, request) : device_.send_force(request);
  } catch (const Error&) {  // the connection thread gets the same error and reports it
    drop_force();
  }
}

bool ForceOutput::wait_for_force() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [&] { return stops_ || has_report(); });
  return !stops_;
}

device::ForceRequest ForceOutput::take_force() {
  newest_ = *std::exchange(next_, std::nullopt);
  if (newest_.pose_sequence) newest_.interval_ms = interval_.next(*newest_.pose_sequence);
  return newest_;
}

device::ForceRequest ForceOutput::repeated_force(const Model& model) const {
  device::ForceRequest request{.mode = protocol::ForceMode::none, .pose_sequence = model.pose_sequence};
  if (newest_.mode == protocol::ForceMode::none || !newest_.pose_sequence) return request;
  const std::uint32_t age = model.pose_sequence - *newest_.pose_sequence;
  if (age > protocol::pose_rate_Hz * model.force_life_s) return request;
  request.force_N = newest_.force_N;
  request.mode = newest_.mode;
  request.interval_ms = std::max(1, newest_.interval_ms - static_cast<int>(age));
  return request;
}

void ForceOutput::drop_force() {
  const std::lock_guard lock(mutex_);
  next_.reset();
  model_.reset();
  newest_ = {.mode = protocol::ForceMode::none};
}

}  // namespace inkwell::library
