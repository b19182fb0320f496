// Two programs at one arm: one drives, the other looks on.
#include <doctest/doctest.h>

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <thread>

#include <device/driver_claim.hpp>

#include "board_rig.hpp"
#include "program.hpp"

namespace inkwell::tests {
namespace {

using namespace std::chrono_literals;
using protocol::Parameter;
using protocol::Signal;

constexpr std::array scope_signals{Signal::force_x_N, Signal::program_force_x_N};

/// The poses that have come.
std::vector<protocol::PoseReport> read_poses(device::Device& device) {
  std::vector<protocol::PoseReport> poses;
  while (auto pose = device.read_pose(0ms)) poses.push_back(*pose);
  return poses;
}

TEST_CASE("a program drives while another has the scope, the poses and the parameters") {
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
  std::vector<protocol::PoseReport> driver_poses, onlooker_poses;
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

  onlooker->set_parameters(std::array<device::ParameterChange, 1>{{{Parameter::wall_stiffness_N_per_m, 444.0f}}});
  CHECK(rig.device->parameters()[Parameter::wall_stiffness_N_per_m] == 444.0f);
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
  const auto result =
      run_program("inkwell", {"record", file, "--seconds", "0.1", "--usbip", std::to_string(board.usbip_port())});
  INFO(result.out, result.err);
  CHECK(result.exit_code == 1);
  CHECK(result.err.find("scope is in use") != std::string::npos);
  CHECK_FALSE(std::filesystem::exists(file));
}

TEST_CASE("two programs that both want to drive: the second is told who the first is") {
  std::optional<device::DriverClaim> first(std::in_place, "sharing-test");
  try {
    const device::DriverClaim second("sharing-test");
    FAIL("both drive");
  } catch (const device::InUse& error) {
    const std::string sentence = error.what();
    CHECK(sentence.find("tests-system (process ") != std::string::npos);
    CHECK(sentence.find("drives this arm already") != std::string::npos);
  }
  const device::DriverClaim other_arm("sharing-test-2");
  first.reset();
  CHECK_NOTHROW(device::DriverClaim("sharing-test"));
}

}  // namespace
}  // namespace inkwell::tests
