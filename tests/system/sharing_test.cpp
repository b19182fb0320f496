// Tests two programs that share one arm. The first program is the driver, and the second program observes.
#include <doctest/doctest.h>

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <thread>

#include <unistd.h>

#include "tests/system/board_rig.hpp"
#include "tests/system/program.hpp"

namespace inkwell::tests {
namespace {

using namespace std::chrono_literals;
using protocol::Parameter;
using protocol::Signal;

constexpr std::array scope_signals{Signal::force_x_N, Signal::program_force_x_N};

std::vector<device::Pose> read_poses(device::Device& device) {
  std::vector<device::Pose> poses;
  while (auto pose = device.read_pose(0ms)) poses.push_back(*pose);
  return poses;
}

TEST_CASE("a program drives while another has the scope and the poses") {
  BoardRig rig;
  rig.take_to(free_point_m);
  rig.make_active();
  const auto endpoint = rig.board.find();
  REQUIRE(endpoint.has_value());
  const auto onlooker = device::Device::open(*endpoint);
  CHECK(onlooker->information().serial_number == rig.device->information().serial_number);
  onlooker->select_signals(scope_signals);
  read_poses(*onlooker);

  std::size_t samples = 0;
  std::uint64_t lost = 0;
  float largest_N = 0;
  std::vector<device::Pose> driver_poses, onlooker_poses;
  for (int millisecond = 0; millisecond < 200; ++millisecond) {
    rig.device->send_force({.force_N = {0.5f, 0.0f, 0.0f}});
    rig.control.run(0.001);
    for (const auto& pose : read_poses(*rig.device)) driver_poses.push_back(pose);
    for (const auto& pose : read_poses(*onlooker)) onlooker_poses.push_back(pose);
    while (const auto frame = onlooker->read_scope(0ms)) {
      samples += frame->count;
      lost += frame->lost_before;
      for (std::size_t i = 1; i < frame->values.size(); i += 2) largest_N = std::max(largest_N, frame->values[i]);
    }
  }
  CHECK(driver_poses.size() >= 199);
  CHECK(onlooker_poses.size() >= 199);
  CHECK(onlooker_poses.back().sequence == driver_poses.back().sequence);
  CHECK(onlooker_poses.back().sequence - onlooker_poses.front().sequence + 1 == onlooker_poses.size());
  CHECK(samples > 3'000);
  CHECK(lost == 0);
  CHECK(largest_N == doctest::Approx(0.5).epsilon(1e-3));
  CHECK(rig.device->information().report.force_reports_lost == 0);

  CHECK(onlooker->parameters() == rig.device->parameters());
}

TEST_CASE(
    "the scope is one program's; when it goes or selects nothing the other may have it, and neither disturbs the "
    "other's poses") {
  BoardRig rig;
  const auto endpoint = rig.board.find();
  REQUIRE(endpoint.has_value());
  std::unique_ptr<device::Device> first = device::Device::open(*endpoint);
  first->select_signals(scope_signals);
  CHECK_THROWS_WITH_AS(rig.device->select_signals(scope_signals),
                       "The arm's scope is in use. Close the other program that records it or shows its signals.",
                       device::InUse);
  SUBCASE("it goes") { first.reset(); }
  SUBCASE("it selects nothing") { first->select_signals({}); }
  rig.run(0.05);
  rig.device->select_signals(scope_signals);
  rig.run(0.05);
  CHECK(rig.device->read_scope(0ms).has_value());
}

TEST_CASE("a recording that may not have the scope leaves no file in the way of the next try") {
  const TemporaryDirectory directory;
  const auto file = directory.file("push.csv");
  const device::VirtualBoard board({.mode = device::SimulationMode::fast, .real_time = true});
  while (!board.find()) std::this_thread::sleep_for(10ms);
  const auto other = device::Device::open(*board.find());
  other->select_signals(scope_signals);
  const auto result = run_program("inkwell", {"record", file, "--seconds", "0.1", "--usbip", board.usbip().text()});
  INFO(result.out, result.err);
  CHECK(result.exit_code == 1);
  CHECK(result.err.find("scope is in use") != std::string::npos);
  CHECK_FALSE(std::filesystem::exists(file));
}

TEST_CASE(
    "of two programs one drives: the second is refused with its name, and may stop the force or take the arm over") {
  BoardRig rig;
  rig.take_to(free_point_m);
  rig.make_active();
  const auto endpoint = rig.board.find();
  REQUIRE(endpoint.has_value());
  const auto second = device::Device::open(*endpoint);
  const auto driver = second->driver();
  REQUIRE(driver.has_value());
  CHECK(driver->program == "tests-system");
  CHECK(driver->process_id == static_cast<std::uint32_t>(getpid()));
  CHECK(driver->object.has_value());
  CHECK_FALSE(driver->is_this_device);
  const auto is_refused = [&](auto request) {
    try {
      request();
      return false;
    } catch (const device::InUse& error) {
      return std::string(error.what()).find("through the arm that it opened as number") != std::string::npos;
    }
  };
  CHECK(is_refused([&] { second->claim(); }));
  CHECK(is_refused([&] { second->disable_force(); }));
  CHECK(is_refused([&] { second->carry_out(protocol::Command::self_test); }));
  CHECK(is_refused([&] { second->place_shapes({}); }));
  constexpr std::array<device::ParameterChange, 1> change{{{Parameter::wall_stiffness_N_per_m, 444.0f}}};
  CHECK(is_refused([&] { second->set_parameters(change); }));
  rig.run(0.01);
  CHECK(protocol::force_is_on(rig.pose().state));
  SUBCASE("stop") {
    second->stop();
    rig.run(0.01);
    CHECK_FALSE(protocol::force_is_on(rig.pose().state));
    CHECK(rig.device->drives());
  }
  SUBCASE("takeover") {
    second->take_over();
    CHECK(second->drives());
    second->set_parameters(change);
    rig.run(0.01);
    CHECK_FALSE(rig.device->drives());
    second->disable_force();
    CHECK(second->parameters()[Parameter::wall_stiffness_N_per_m] == 444.0f);
  }
}

}  // namespace
}  // namespace inkwell::tests
