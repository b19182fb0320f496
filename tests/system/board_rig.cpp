#include "tests/system/board_rig.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>
#include <utility>

#include <doctest/doctest.h>
#include "tests/stepped_board.hpp"

#include "tests/system/program.hpp"

namespace inkwell::tests {
namespace {

using namespace std::chrono_literals;

device::VirtualBoardOptions options(device::SimulationMode mode, std::uint64_t seed, device::CyclePricing pricing) {
  auto options = stepped_board(mode, pricing);
  options.seed = seed;
  return options;
}

device::VirtualBoardOptions with_image(device::VirtualBoardOptions options, const std::string& image) {
  options.elf = build_directory() + "/../board/" + image;
  return options;
}

device::VirtualBoardOptions strictly(device::VirtualBoardOptions options) {
  options.strict = true;
  return options;
}

constexpr double slice_s = 0.01;
constexpr double sign_of_life_s = 0.5;

}  // namespace

BoardRig::BoardRig(device::SimulationMode mode, std::uint64_t seed, device::CyclePricing pricing)
    : BoardRig(options(mode, seed, pricing)) {}

BoardRig::BoardRig(const std::string& image)
    : BoardRig(with_image(options(device::SimulationMode::fast, 1, device::CyclePricing::likely), image)) {}

BoardRig::BoardRig(device::VirtualBoardOptions options)
    : board(strictly(options)), control(board.control()), seed_(options.seed) {
  control.stand_by();
  connect();
  run(0.05);
}

void BoardRig::connect() {
  const double begin_s = board_time_s();
  std::optional<device::Endpoint> endpoint;
  while (!(endpoint = board.find())) {
    REQUIRE_MESSAGE(board_time_s() < begin_s + 1.0, "the device did not enumerate within a second of board time");
    control.run(slice_s);
  }
  endpoint->seed = seed_;
  device = device::Device::open(*endpoint);
  set({{protocol::Parameter::host_timeout_s, 2.0f}});  // the tests decide when the host is silent
}

// control.run() returns after the host has received everything that the device sent.
void BoardRig::pass_slice() {
  control.run(slice_s);
  const std::size_t before = poses_.size();
  while (auto pose = device->read_pose(0ms)) poses_.push_back(*pose);
  REQUIRE_MESSAGE(poses_.size() > before, "the pose reports stopped");
  since_sign_of_life_s_ += slice_s;
}

void BoardRig::run_silent(double time_s) {
  for (auto slices = std::lround(time_s / slice_s); slices > 0; --slices) pass_slice();
}

void BoardRig::run(double time_s) {
  for (auto slices = std::lround(time_s / slice_s); slices > 0; --slices) {
    pass_slice();
    if (since_sign_of_life_s_ >= sign_of_life_s) command(protocol::Command::heartbeat);
  }
}

void BoardRig::set(std::initializer_list<device::ParameterChange> changes) {
  device->set_parameters(std::vector<device::ParameterChange>(changes));
}

void BoardRig::command(protocol::Command command) {
  device->send(command);
  since_sign_of_life_s_ = 0;
}

void BoardRig::push(const device::ForceRequest& force) {
  while (const auto pose = device->read_pose(0ms)) poses_.push_back(*pose);
  device->send_force(force);
  control.run(0.001);
}

void BoardRig::run_until(const std::function<bool(const device::Pose&)>& condition, double limit_s) {
  for (double passed_s = 0; passed_s < limit_s; passed_s += slice_s) {
    if (!poses_.empty() && condition(pose())) return;
    run(slice_s);
  }
  REQUIRE_MESSAGE(condition(pose()), "the condition was not reached in time; state ",
                  std::string(protocol::info(pose().state).name), ", fault ",
                  std::string(protocol::info(pose().fault).name));
}

void BoardRig::take_to(device::Vector3 target_m, double duration_s) {
  run(bring_stylus(control, target_m, duration_s));
}

void BoardRig::make_active() {
  run_until([](const auto& pose) { return pose.state == protocol::State::ready; });
  device->claim();
  command(protocol::Command::enable_force);
  run_until([](const auto& pose) { return protocol::force_is_on(pose.state); });
}

protocol::SelfTestReport self_test_after_reset(BoardRig& rig) {
  rig.device.reset();
  rig.control.reset();
  rig.control.run(0.05);
  rig.connect();
  rig.run(0.3);
  return rig.device->read_self_test();
}

double largest_current_A(device::ControlClient& control) {
  const auto truth = control.truth();
  double largest = 0;
  for (const char* name : {"true_current_1_A", "true_current_2_A", "true_current_3_A"})
    largest = std::max(largest, std::abs(truth.at(name).get<double>()));
  return largest;
}

}  // namespace inkwell::tests
