#include "host/lab/experiment/paced_device.hpp"

#include <fmt/format.h>

#include "host/client/device/fault_text.hpp"
#include "protocol/reports.hpp"

namespace inkwell::experiment {
namespace {

using namespace std::chrono_literals;

// Step of board time. The link can buffer 100 ms of scope data.
constexpr std::chrono::nanoseconds slice = 5ms;
constexpr double slice_s = std::chrono::duration<double>(slice).count();
constexpr unsigned slices_per_sign_of_life = 2;
constexpr auto control_period = std::chrono::nanoseconds(1s) / protocol::servo_rate_Hz;
constexpr auto slice_poses = static_cast<std::uint64_t>(slice_s * protocol::pose_rate_Hz);
// The device is considered dead after 30 s without a pose.
constexpr auto read_timeout = 10ms;
constexpr int silent_reads_limit = 3000;
constexpr double command_limit_s = 0.5;

std::chrono::nanoseconds nanoseconds(double time_s) {
  return std::chrono::round<std::chrono::nanoseconds>(std::chrono::duration<double>(time_s));
}

/// Tokens count from 1 to 255 and then restart at 1. Token 0 means that no command was executed. The device executes
/// commands in order, so a later token also confirms an earlier command.
bool is_at_or_after(std::uint8_t token, std::uint8_t awaited) {
  constexpr int tokens = 255;
  return token != 0 && (token - awaited + tokens) % tokens < tokens / 2;
}

}  // namespace

void PacedDevice::read_poses(std::chrono::milliseconds timeout) {
  const std::uint64_t before = poses_received_;
  while (const auto pose = device_.read_pose(timeout)) {
    ++poses_received_;
    if (pose_) {
      poses_lost_ += pose->sequence - pose_->sequence - 1;
      if (control_ == nullptr) passed_ += control_period * (pose->time_periods - pose_->time_periods);
    }
    pose_ = pose;
    timeout = 0ms;
    if (pose->state == protocol::State::fault)
      throw device::Error("The device reports the fault " + device::fault_line(pose->fault));
  }
  if (timeout == 0ms && poses_received_ == before) return;  // a poll without waiting
  silent_reads_ = poses_received_ > before ? 0 : silent_reads_ + 1;
  if (silent_reads_ > silent_reads_limit)
    throw device::Error("The device is silent. Reset the board and run the experiment again.");
}

void PacedDevice::pass_slice() {
  if (control_ == nullptr) {
    device_.keep_alive();
    return read_poses(read_timeout);
  }
  // Heartbeats depend only on board time, so that each run is the same.
  if (slices_++ % slices_per_sign_of_life == 0) device_.send(protocol::Command::heartbeat);
  const std::uint64_t before = poses_received_;
  control_->run(slice_s);
  passed_ += slice;
  // Board time is stopped now, but reports of the slice may still be in transit. Up to two reports arrive in the next
  // slice.
  const std::uint64_t expected = pose_ ? slice_poses - 2 : 0;
  read_poses(0ms);
  while (poses_received_ - before < expected) read_poses(read_timeout);
}

void PacedDevice::pass(double time_s) {
  read_poses(0ms);  // discards old poses
  const auto end = passed_ + nanoseconds(time_s);
  while (passed_ < end) pass_slice();
}

void PacedDevice::wait_until(const std::function<bool()>& condition, double limit_s, const std::string& otherwise) {
  read_poses(0ms);
  const auto deadline = passed_ + nanoseconds(limit_s);
  while (!condition()) {
    if (passed_ > deadline) throw device::Error(otherwise);
    pass_slice();
  }
}

void PacedDevice::wait_for_pose(const std::function<bool(const device::Pose&)>& condition, double limit_s,
                                const std::string& otherwise) {
  wait_until([&] { return pose_ && condition(*pose_); }, limit_s, otherwise);
}

void PacedDevice::wait_for_token(std::uint8_t token) {
  wait_for_pose([&](const auto& pose) { return is_at_or_after(pose.command_token, token); }, command_limit_s,
                "The device does not execute commands. Reset the board and run the experiment again.");
}

}  // namespace inkwell::experiment
