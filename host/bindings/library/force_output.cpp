#include "host/bindings/library/force_output.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "host/bindings/library/errors.hpp"

namespace inkwell::library {
namespace {

/// Longest delay of stop() if the device accepts no force.
constexpr auto attention = std::chrono::milliseconds(20);

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

void ForceOutput::let_go() {
  const std::lock_guard lock(mutex_);
  next_ = device::ForceRequest{.mode = protocol::ForceMode::none};
  changed_.notify_one();
}

void ForceOutput::before_pose() {
  {
    const std::lock_guard lock(mutex_);
    if (stops_ || !next_) return;
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
    device::ForceRequest request = take_force();
    if (request.pose_sequence) request.interval_ms = interval_.next(*request.pose_sequence);
    if (poses_.loss() == Loss::none) device_.send_force(request);  // otherwise the force belongs to an older pose
  } catch (const Error&) {  // the connection thread gets the same error and reports it
    drop_force();
  }
}

bool ForceOutput::wait_for_force() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [&] { return stops_ || next_; });
  return !stops_;
}

device::ForceRequest ForceOutput::take_force() {
  const std::lock_guard lock(mutex_);
  return *std::exchange(next_, std::nullopt);
}

void ForceOutput::drop_force() {
  const std::lock_guard lock(mutex_);
  next_.reset();
}

}  // namespace inkwell::library
