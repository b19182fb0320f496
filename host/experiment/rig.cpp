#include "rig.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

#include <fmt/format.h>

#include <protocol/reports.hpp>

namespace inkwell::experiment {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

// Short against the host's time-out, and against the 100 ms of scope that the link keeps room for.
constexpr double slice_s = 0.005;
constexpr std::uint32_t slice_poses = static_cast<std::uint32_t>(slice_s * protocol::pose_rate_Hz);
constexpr auto patience = 5s;  // of the wall clock, with a virtual board that may be slow
constexpr double command_limit_s = 0.5;

}  // namespace

void Rig::read_poses(std::chrono::milliseconds timeout) {
  while (const auto pose = device_.read_pose(timeout)) {
    ++poses_received_;
    if (pose_) poses_lost_ += pose->sequence - pose_->sequence - 1;
    pose_ = pose;
    timeout = 0ms;
    if (pose->state == protocol::State::fault) {
      const auto& fault = protocol::info(pose->fault);
      throw device::Error(fmt::format("The device reports the fault {}: {} {}", fault.name, fault.cause, fault.remedy));
    }
  }
}

void Rig::pass_slice() {
  device_.keep_alive();
  if (control_ == nullptr) {
    read_poses(std::chrono::milliseconds(slice_poses));
    return;
  }
  const std::uint64_t before = poses_received_;
  control_->run(slice_s);
  // Board time stands still now; the reports of the slice may still be on their way. One or two of them belong to
  // frames that the slice's end cut.
  const auto give_up_at = Clock::now() + patience;
  const std::uint64_t expected = pose_ ? slice_poses - 2 : 0;
  read_poses(0ms);
  while (poses_received_ - before < expected) {
    if (Clock::now() > give_up_at) throw device::Error("The pose reports stopped. Run the experiment again.");
    read_poses(10ms);
  }
}

void Rig::pass(double time_s) {
  if (control_ != nullptr) {
    for (auto slices = std::lround(time_s / slice_s); slices > 0; --slices) pass_slice();
    return;
  }
  const auto end = Clock::now() + std::chrono::duration<double>(time_s);
  while (Clock::now() < end) pass_slice();
}

void Rig::wait_until(const std::function<bool(const protocol::PoseReport&)>& condition, double limit_s,
                     const std::string& otherwise) {
  for (double passed_s = 0; !pose_ || !condition(*pose_); passed_s += slice_s) {
    if (passed_s > limit_s) throw device::Error(otherwise);
    pass_slice();
  }
}

void Rig::wait_for_token(std::uint8_t token) {
  wait_until([&](const protocol::PoseReport& pose) { return pose.command_token == token; }, command_limit_s,
             "The device does not carry out commands. Reset the board and run the experiment again.");
}

ScopeCapture::ScopeCapture(device::Device& device) : device_(device) {
  thread_ = std::thread([this] {
    try {
      while (!stopping_) {
        const auto samples = device_.read_scope(10ms);
        if (!samples) continue;
        const std::lock_guard lock(mutex_);
        recording_.append(*samples);
      }
    } catch (const device::Error& error) {
      const std::lock_guard lock(mutex_);
      failure_ = error.what();
    }
  });
}

ScopeCapture::~ScopeCapture() {
  stopping_ = true;
  thread_.join();
}

std::size_t ScopeCapture::size() const {
  const std::lock_guard lock(mutex_);
  return recording_.size();
}

ScopeRecording ScopeCapture::take(std::size_t samples) {
  const auto give_up_at = Clock::now() + patience;
  for (;;) {
    {
      const std::lock_guard lock(mutex_);
      if (failure_) throw device::Error(*failure_);
      if (recording_.lost_samples > 0)
        throw device::Error(
            fmt::format("{} samples of the scope were lost, so the recording has gaps. Close other "
                        "programs that load this computer and run the experiment again.",
                        recording_.lost_samples));
      if (recording_.size() >= samples) {
        ScopeRecording taken = recording_;
        taken.values.resize(samples * taken.signals.size());
        return taken;
      }
    }
    if (Clock::now() > give_up_at)
      throw device::Error(fmt::format("The scope sent {} of {} samples. Reset the board and run the experiment again.",
                                      size(), samples));
    std::this_thread::sleep_for(5ms);
  }
}

}  // namespace inkwell::experiment
