#include "host/companion/command_line/guided_device.hpp"

#include <algorithm>
#include <chrono>
#include <thread>
#include <utility>

namespace inkwell::command_line {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

constexpr double connection_limit_s = 15;

}  // namespace

GuidedDevice::GuidedDevice(const DeviceOptions& options) {
  std::vector<device::ParameterChange> changes;
  if (!options.arm.empty()) changes = device::arm_parameters(options.arm);
  if (options.is_virtual) {
    protocol::ParameterSet arm = protocol::default_parameters();
    for (const auto& [parameter, value] : changes) arm[parameter] = value;
    board_ = std::make_unique<device::VirtualBoard>(
        options.virtual_board(device::SimulationMode::fast, BoardPace::real_time));
    user_.emplace(board_->control(), arm);
    session_ = std::make_unique<device::Session>([this] { return board_->find(); });
  } else {
    const auto endpoint = device::find_arm(options.address());  // fails immediately if there is no arm
    session_ = std::make_unique<device::Session>([endpoint] { return endpoint; });
  }
  session_->on_scope([this](const device::ScopeSamples& samples) {
    const std::lock_guard lock(mutex_);
    frames_.push_back(samples);
  });
  wait_for_device();
  if (!changes.empty()) apply_parameters(changes);
}

void GuidedDevice::wait_for_device() {
  const auto begin = Clock::now();
  // For a virtual board, the time limit is in board time, because a busy computer slows the board down.
  std::optional<device::ControlClient> control;
  if (board_) control.emplace(board_->control());
  const auto waited_s = [&]() -> double {
    if (!control) return std::chrono::duration<double>(Clock::now() - begin).count();
    const auto status = control->status();
    status.insist_on_running();
    return status.board_time_s;
  };
  for (;;) {
    const auto status = session_->status();
    if (status.connection == device::Connection::connected && session_->newest_pose()) return;
    const bool hopeless =
        status.connection == device::Connection::incompatible || status.connection == device::Connection::no_permission;
    if (hopeless || waited_s() > connection_limit_s) throw device::Error(status.message);
    std::this_thread::sleep_for(5ms);
  }
}

void GuidedDevice::apply_parameters(const std::vector<device::ParameterChange>& changes) {
  session_->set_parameters(changes);
  auto limit = transaction_limit();
  const auto holds_them = [&] {
    const auto held = session_->parameters();
    return held &&
           std::ranges::all_of(changes, [&](const auto& change) { return (*held)[change.first] == change.second; });
  };
  while (!holds_them()) {
    if (limit.update_time(session_->newest_pose()))
      throw device::Error(
          session_->refusal().value_or("The device did not accept the parameters of the arm description. Try again."));
    std::this_thread::sleep_for(5ms);
  }
}

std::vector<device::ScopeSamples> GuidedDevice::take_frames() {
  const std::lock_guard lock(mutex_);
  return std::exchange(frames_, {});
}

void GuidedDevice::carry_out(const guides::UserTask& task) {
  if (user_) user_->advance(task);
}

void GuidedDevice::store_parameters() {
  session_->store_parameters();
  while (session_->status().is_storing) std::this_thread::sleep_for(5ms);
  const auto status = session_->status();
  if (status.connection != device::Connection::connected) throw device::Error(status.message);
  if (status.store_problem) throw device::Error(*status.store_problem);
}

}  // namespace inkwell::command_line
