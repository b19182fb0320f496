#include "board_rig.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

#include <doctest/doctest.h>

namespace inkwell::tests {
namespace {

using namespace std::chrono_literals;

device::VirtualBoardOptions options(device::SimulationMode mode, std::uint64_t seed) {
  device::VirtualBoardOptions options;
  options.mode = mode;
  options.seed = seed;
  options.real_time = false;
  options.paused = true;
  return options;
}

constexpr double slice_s = 0.01;
constexpr double sign_of_life_s = 0.5;

}  // namespace

BoardRig::BoardRig(device::SimulationMode mode, std::uint64_t seed)
    : board(options(mode, seed)), control(board.control()) {
  std::optional<device::Endpoint> endpoint;
  while (!endpoint) {
    REQUIRE_MESSAGE(board_time_s() < 1.0, "the device did not enumerate within a second of board time");
    control.run(slice_s);
    endpoint = board.find();
  }
  control.resume();
  device = device::Device::open(*endpoint);
  // Tests decide when the host is silent; a busy test machine does not.
  device->set_parameters(std::vector<device::ParameterChange>{{protocol::Parameter::host_timeout_s, 2.0f}});
  control.pause();
  run(0.05);
}

std::size_t BoardRig::collect(std::chrono::milliseconds timeout) {
  std::size_t count = 0;
  while (auto pose = device->read_pose(count == 0 ? timeout : 0ms)) {
    poses_.push_back(*pose);
    ++count;
  }
  return count;
}

void BoardRig::run(double time_s) {
  const auto slices = static_cast<int>(std::lround(time_s / slice_s));
  std::size_t received = 0;
  for (int slice = 1; slice <= slices; ++slice) {
    control.run(slice_s);
    // A slice holds ten reports; at most two of them may still be on their way.
    const auto expected = static_cast<std::size_t>(slice * 10 - 2);
    while (received < expected) {
      const std::size_t arrived = collect(2000ms);
      REQUIRE_MESSAGE(arrived > 0, "the pose reports stopped");
      received += arrived;
    }
    since_sign_of_life_s_ += slice_s;
    if (since_sign_of_life_s_ >= sign_of_life_s) command(protocol::Command::heartbeat);
  }
}

void BoardRig::set(std::initializer_list<device::ParameterChange> changes) {
  call([&](device::Device& arm) { arm.set_parameters(std::vector<device::ParameterChange>(changes)); });
}

void BoardRig::command(protocol::Command command) {
  call([&](device::Device& arm) { arm.send(command); });
  since_sign_of_life_s_ = 0;
}

void BoardRig::run_until(const std::function<bool(const protocol::PoseReport&)>& condition, double limit_s) {
  for (double passed_s = 0; passed_s < limit_s; passed_s += slice_s) {
    if (!poses_.empty() && condition(pose())) return;
    run(slice_s);
  }
  REQUIRE_MESSAGE(condition(pose()), "the condition was not reached in time; state ",
                  std::string(protocol::info(pose().state).name), ", fault ",
                  std::string(protocol::info(pose().fault).name));
}

void BoardRig::take_to(device::Vector3 target_m, double duration_s) {
  const auto truth = control.truth();
  const device::Vector3 here_m{truth.at("true_position_x_m"), truth.at("true_position_y_m"),
                               truth.at("true_position_z_m")};
  control.hand({.holds = true, .target_m = here_m, .stiffness_N_per_m = 1500, .damping_Ns_per_m = 15});
  control.dock(false);
  control.hand_path({{0.0, here_m}, {duration_s, target_m}});
  run(duration_s + 0.3);
}

void BoardRig::make_active() {
  run_until([](const auto& pose) { return pose.state == protocol::State::ready; });
  command(protocol::Command::enable_force);
  run_until([](const auto& pose) { return pose.state == protocol::State::active; });
}

double largest_current_A(device::ControlClient& control) {
  const auto truth = control.truth();
  double largest = 0;
  for (const char* name : {"true_current_1_A", "true_current_2_A", "true_current_3_A"})
    largest = std::max(largest, std::abs(truth.at(name).get<double>()));
  return largest;
}

}  // namespace inkwell::tests
