// Tests the device from the host: enumeration, identity, parameters, streams, disconnection.
#include <doctest/doctest.h>

#include <signal.h>

#include <cmath>
#include <filesystem>
#include <limits>
#include <system_error>
#include <thread>

#include <nlohmann/json.hpp>

#include "boards/omni_driver/facts.hpp"
#include "tests/failure.hpp"

#include "tests/stepped_board.hpp"

#include "tests/system/board_rig.hpp"
#include "tests/system/program.hpp"

using namespace inkwell;
using namespace inkwell::tests;
using protocol::Parameter;
using namespace std::chrono_literals;

namespace {

std::vector<protocol::Signal> floating_point_signals(std::size_t count) {
  std::vector<protocol::Signal> signals;
  for (std::uint8_t id = 3; signals.size() < count; ++id)
    if (protocol::signal_table[id].wire == protocol::SignalWire::float32)
      signals.push_back(static_cast<protocol::Signal>(id));
  return signals;
}

}  // namespace

TEST_CASE("the device enumerates within a second of board time and reports its identity") {
  BoardRig rig;  // throws if the device is not present by then
  const auto information = rig.device->information();
  CHECK(information.protocol_version == protocol::protocol_version);
  CHECK(information.report.parameter_table_hash == protocol::parameter_table_hash);
  CHECK(information.report.signal_table_hash == protocol::signal_table_hash);
  CHECK(information.report.servo_rate_Hz == protocol::servo_rate_Hz);
  CHECK(information.report.processor_clock_Hz == board::processor_Hz);
  CHECK(information.serial_number.size() == 24);
  const auto status = rig.control.status();
  INFO("registers that the virtual chip does not model: ", status.all.at("unmodelled").dump());
  CHECK(status.unmodelled.empty());
}

TEST_CASE("the firmware starts as well when the chip's boot loader starts it") {
  auto options = stepped_board(device::SimulationMode::fast, device::CyclePricing::likely);
  options.from_boot_loader = true;
  BoardRig rig(options);
  rig.make_active();
  rig.run(0.1);
  CHECK(protocol::force_is_on(rig.pose().state));
  CHECK(rig.device->information().report.servo_overruns == 0);
}

TEST_CASE("the firmware prints its name and the reset cause on its console") {
  const auto image = std::filesystem::path(build_directory()) / ".." / "board" / "inkwell.elf";
  const auto result = run_program("virtual-board",
                                  {"--elf", image.string(), "--uart", "usart2=stdio", "--seconds", "0.05", "--strict"});
  CHECK(result.exit_code == 0);
  CHECK(result.out.find("\ninkwell ") != std::string::npos);
  CHECK(result.out.find(", reset cause 0000000e\r\n") != std::string::npos);
}

TEST_CASE("the seed of a virtual board determines its serial number") {
  const auto serial_number_of = [](std::uint64_t seed) {
    return BoardRig(device::SimulationMode::fast, seed).device->information().serial_number;
  };
  CHECK(serial_number_of(1) == "000000010000000039323539");
  CHECK(serial_number_of(0xABCDEF0012345678) == "12345678ABCDEF0039323539");
}

TEST_CASE(
    "the serial number of a board follows from its flash file, port, seed or option, and otherwise differs at each "
    "start") {
  const TemporaryDirectory directory;
  std::string port;
  const auto number_of = [&](std::vector<std::string> words) {
    words.insert(words.begin(),
                 {build_directory() + "/virtual-board", "--elf", build_directory() + "/../board/inkwell.elf"});
    RunningProgram board(words);
    const std::string ready = board.read_line();
    port = ready.substr(ready.find("usbip=") + 6);
    port.resize(port.find(' '));
    // On a busy machine, the list may be complete before the arm appears.
    auto listed = run_program("inkwell", {"devices", "--json", "--usbip", port});
    for (int again = 0; listed.exit_code != 0 && again < 30; ++again)
      listed = run_program("inkwell", {"devices", "--json", "--usbip", port});
    CAPTURE(listed.err);
    REQUIRE(listed.exit_code == 0);
    kill(board.process(), SIGTERM);
    board.wait();
    return nlohmann::json::parse(listed.out)[0].at("serial_number").get<std::string>();
  };
  const auto one = number_of({"--flash", directory.file("one.flash")});
  CHECK(number_of({"--flash", directory.path() + "/./one.flash"}) == one);
  CHECK(number_of({"--flash", directory.file("other.flash")}) != one);
  const auto of_this_run = number_of({});
  CHECK(number_of({}) != of_this_run);
  const auto at_port = number_of({"--usbip", port});
  CHECK(number_of({"--usbip", port}) == at_port);
  CHECK(number_of({"--seed", "7"}) == "000000070000000039323539");
  CHECK(number_of({"--seed", "7", "--serial", "2a"}) == "00000000000000000000002A");
  const auto refused =
      run_program("virtual-board", {"--elf", build_directory() + "/../board/inkwell.elf", "--serial", "mine"});
  CHECK(refused.exit_code == 2);
  CHECK(refused.err.find("24 hexadecimal digits") != std::string::npos);
}

TEST_CASE("the device has the defaults of the table, applies a transaction as a whole, and restores the defaults") {
  BoardRig rig;
  const auto before = rig.device->parameters();
  auto expected = protocol::default_parameters();
  expected[Parameter::host_timeout_s] = 2.0f;  // set by the test fixture
  CHECK(before == expected);

  rig.set({{Parameter::wall_stiffness_N_per_m, 432.0f},
           {Parameter::wall_damping_Ns_per_m, 1.5f},
           {Parameter::box_minimum_z_m, -0.05f}});
  const auto after = rig.device->parameters();
  CHECK(after[Parameter::wall_stiffness_N_per_m] == 432.0f);
  CHECK(after[Parameter::wall_damping_Ns_per_m] == 1.5f);
  CHECK(after[Parameter::box_minimum_z_m] == -0.05f);

  rig.device->restore_default_parameters();
  CHECK(rig.device->parameters() == protocol::default_parameters());
}

TEST_CASE("a refused transaction reports the reason and changes nothing") {
  BoardRig rig;
  const auto before = rig.device->parameters();
  const auto refused_with = [&](std::vector<device::ParameterChange> changes) {
    try {
      rig.device->set_parameters(changes);
    } catch (const device::Refused& refused) {
      CHECK(std::string(refused.what()).size() > 20);
      return refused.report.refusal;
    }
    return protocol::Refusal::accepted;
  };
  const float nan = std::numeric_limits<float>::quiet_NaN(), infinity = std::numeric_limits<float>::infinity();
  const device::ParameterChange good{Parameter::wall_stiffness_N_per_m, 100.0f};
  CHECK(refused_with({good, {Parameter::wall_damping_Ns_per_m, nan}}) == protocol::Refusal::not_finite);
  CHECK(refused_with({good, {Parameter::wall_damping_Ns_per_m, infinity}}) == protocol::Refusal::not_finite);
  CHECK(refused_with({good, {Parameter::wall_damping_Ns_per_m, -1.0f}}) == protocol::Refusal::out_of_range);
  CHECK(refused_with({good, {Parameter::transmission, 0.5f}}) == protocol::Refusal::not_whole);
  CHECK(refused_with({good, {Parameter::box_minimum_x_m, 0.2f}}) == protocol::Refusal::inconsistent);
  CHECK(refused_with({good, good}) == protocol::Refusal::given_twice);
  CHECK(rig.device->parameters() == before);
  CHECK(refused_with({good}) == protocol::Refusal::accepted);
}

TEST_CASE("1000 poses a second and 14 signals at 20 kHz arrive for 4 s, none lost") {
  BoardRig rig;
  rig.device->select_signals(floating_point_signals(14));

  std::uint64_t samples = 0, lost = 0;
  std::optional<std::int64_t> first_period;
  const auto first_pose = rig.poses().size();
  constexpr int seconds = 4;
  for (int slice = 0; slice < seconds * 50; ++slice) {
    rig.run(0.02);
    while (const auto frame = rig.device->read_scope(0ms)) {
      if (!first_period)
        first_period = frame->first_period;
      else
        lost += frame->lost_before;
      samples += frame->count;
    }
  }
  const auto& poses = rig.poses();
  std::uint64_t gaps = 0;
  for (std::size_t i = first_pose + 1; i < poses.size(); ++i) gaps += poses[i].sequence - poses[i - 1].sequence - 1;
  const double board_s = (poses.back().time_periods - poses[first_pose].time_periods) * 50e-6;
  MESSAGE("simulation: ", poses.size() - first_pose, " poses and ", samples, " samples in ", board_s,
          " s of board time");
  CHECK(gaps == 0);
  CHECK(lost == 0);
  CHECK(board_s >= seconds - 0.1);
  CHECK((poses.size() - first_pose - 1) / board_s == doctest::Approx(1000).epsilon(0.001));
  CHECK(samples >= static_cast<std::uint64_t>((seconds - 0.2) * protocol::servo_rate_Hz));
  const auto information = rig.device->information();
  CHECK(information.report.scope_samples_dropped == 0);
  CHECK(information.report.servo_overruns == 0);
}

TEST_CASE("a wiper shows neither in its neighbour's reading nor in the supply's") {
  // One converter samples potentiometers and supply in turn. A sampling time that is too short would mix adjacent
  // inputs.
  BoardRig rig;
  using protocol::Signal;
  const std::vector signals{Signal::gimbal_1_rad, Signal::gimbal_2_rad, Signal::gimbal_3_rad, Signal::supply_V};
  const auto means = [&](const device::Vector3& angles_rad) {
    rig.control.gimbal(angles_rad);
    rig.run(0.2);  // the readings are filtered
    rig.device->select_signals(signals);
    rig.run(0.1);
    std::array<double, 4> sums{};
    std::size_t count = 0;
    while (const auto samples = rig.device->read_scope(0ms)) {
      for (std::size_t i = 0; i < samples->values.size(); ++i) sums[i % 4] += samples->values[i];
      count += samples->count;
    }
    REQUIRE(count > 1000);
    for (double& sum : sums) sum /= static_cast<double>(count);
    return sums;
  };
  // Adjacent potentiometers are at opposite ends of their ranges.
  constexpr device::Vector3 one_way_rad{-2.3, 1.6, -2.3}, other_way_rad{2.3, -0.4, 2.3};
  const auto one_way = means(one_way_rad), other_way = means(other_way_rad);
  const double steepest_rad = rig.device->parameters()[Parameter::gimbal_3_slope_rad];
  const double two_counts_rad = 2 * steepest_rad / board::adc_counts;
  for (std::size_t i = 0; i < 3; ++i) {
    CAPTURE(i);
    CHECK(std::abs(one_way[i] - one_way_rad[i]) < two_counts_rad);
    CHECK(std::abs(other_way[i] - other_way_rad[i]) < two_counts_rad);
  }
  CHECK(std::abs(one_way[3] - other_way[3]) < 2 * static_cast<double>(board::omni_driver.supply_step_V()));
}

TEST_CASE("a host that does not read the scope loses the oldest samples, counted, and nothing else") {
  BoardRig rig;
  rig.device->select_signals(floating_point_signals(14));
  rig.run(6.0);  // much longer than the capacity of all buffers
  const auto longest = rig.device->information().report;
  CHECK(longest.scope_samples_dropped > 20'000);
  CHECK(longest.servo_overruns == 0);
  std::uint64_t gaps = 0;
  for (std::size_t i = 1; i < rig.poses().size(); ++i)
    gaps += rig.poses()[i].sequence - rig.poses()[i - 1].sequence - 1;
  CHECK(gaps == 0);
}

TEST_CASE(
    "a program that the computer stops for a while loses nothing, and the control socket names the program that the "
    "board waits for") {
  const TemporaryDirectory directory;
  const std::string file = directory.file("whole.csv");
  device::VirtualBoardOptions options;
  options.real_time = false;
  device::VirtualBoard board(options);
  while (!board.find()) std::this_thread::sleep_for(5ms);
  RunningProgram program(
      {build_directory() + "/inkwell", "record", "--usbip", board.usbip().text(), file, "--seconds", "2", "--json"});
  std::error_code error;
  while (std::filesystem::file_size(file, error) < 100'000 || error) {
    REQUIRE(kill(program.process(), 0) == 0);
    std::this_thread::sleep_for(1ms);
  }
  kill(program.process(), SIGSTOP);
  auto control = board.control();
  device::BoardStatus status;
  // Waits until the status names the program that the board waits for.
  do status = control.status();
  while (status.all["usb"]["waits_for"].empty());
  CHECK(status.all["usb"]["waits_for"][0] == "inkwell (process " + std::to_string(program.process()) + ")");
  std::this_thread::sleep_for(2s);  // longer than the capacity of all buffers
  CHECK(control.status().board_time_s - status.board_time_s < 0.1);
  CHECK(contains(message_of<device::Error>([&] {
                   for (;;) control.supply(18.0);  // the first requests may precede a frame
                 }),
                 "board time waits for inkwell (process "));
  kill(program.process(), SIGCONT);
  const auto recorded = nlohmann::json::parse(program.read_line());
  CHECK(recorded["samples"] == 2 * protocol::servo_rate_Hz);
  CHECK(recorded["lost"] == 0);
  CHECK(control.status().all["usb"]["waits_for"].empty());
}

TEST_CASE("pulling the USB cable ends the connection, plugging it in brings the device back") {
  BoardRig rig;
  rig.make_active();
  rig.control.usb(false);
  CHECK_THROWS_AS(
      [&] {
        for (int i = 0; i < 1000; ++i) rig.device->read_pose(10ms);
      }(),
      device::Disconnected);
  rig.device.reset();
  rig.control.run(0.2);
  CHECK_FALSE(rig.board.find().has_value());

  rig.control.usb(true);
  rig.connect();
  rig.run(0.01);
  const auto pose = rig.pose();
  // The disconnection switches the force off and leaves the arm referenced.
  CHECK(pose.state == protocol::State::fault);
  CHECK(pose.fault == protocol::Fault::usb_gone);
  rig.command(protocol::Command::clear_fault);
  rig.run_until([](const auto& now) { return now.state == protocol::State::ready; });
}
