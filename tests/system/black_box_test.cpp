// Tests that the board's black box shows the cause of a fault or a crash.
#include <doctest/doctest.h>

#include <filesystem>
#include <string>

#include "boards/known/boards.hpp"
#include "boards/omni_driver/facts.hpp"
#include "host/client/crash/crash_text.hpp"
#include "host/client/device/error.hpp"
#include "tests/stepped_board.hpp"

#include "tests/system/firmware_image.hpp"
#include "tests/system/hazards.hpp"
#include "tests/system/program.hpp"

using namespace inkwell;
using namespace inkwell::tests;
using protocol::Fault;
using protocol::Signal;
using protocol::State;

namespace {

float value(const protocol::BlackBoxRow& row, Signal signal) { return row.values[static_cast<std::size_t>(signal)]; }

/// Checks that the rows are one millisecond apart on both sides of the fault.
void check_times(const protocol::BlackBoxReport& box, const std::vector<protocol::BlackBoxRow>& rows) {
  REQUIRE(rows.size() == box.row_count);
  int wrong = 0;
  for (std::size_t i = 1; i < rows.size(); ++i)
    wrong +=
        i != box.rows_before && rows[i].time_periods - rows[i - 1].time_periods != protocol::black_box_step_periods;
  CHECK(wrong == 0);
}

/// Checks the rows before a crash. The sphere is pressed into a wall before the crash.
void check_rows_until_crash(const protocol::BlackBoxReport& box, const std::vector<protocol::BlackBoxRow>& rows) {
  CHECK(box.is_complete == 1);
  CHECK(box.is_restart == 1);
  CHECK(box.rows_before == protocol::black_box_rows_before);
  check_times(box, rows);
  REQUIRE_FALSE(rows.empty());
  CHECK(rows.back().time_periods == box.fault_periods);
  for (const auto& row : rows) CHECK(value(row, Signal::force_z_N) > 0.1f);
}

}  // namespace

TEST_CASE("the black box of a failing supply contains the supply drop, the bridge switch-off and the time after it") {
  BoardRig rig;
  press_into_wall(rig);
  CHECK(rig.device->black_box().fault == Fault::none);
  rig.control.supply(9.0);
  rig.run_until([](const auto& pose) { return pose.state == State::fault; });
  rig.run(0.12);
  const auto box = rig.device->black_box();
  CHECK(box.fault == Fault::supply_low);
  CHECK(box.is_complete == 1);
  CHECK(box.is_restart == 0);
  CHECK(box.crash.exception == 0);
  CHECK(box.rows_before == protocol::black_box_rows_before);
  const auto rows = rig.device->black_box_rows(box);
  REQUIRE(rows.size() == protocol::black_box_rows_maximum);
  check_times(box, rows);
  const auto& at_fault = rows[box.rows_before];
  CHECK(at_fault.time_periods == box.fault_periods);
  CHECK(value(at_fault, Signal::supply_V) < board::supply_minimum_V);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const bool is_before = i < box.rows_before;
    CHECK((value(rows[i], Signal::supply_V) >= board::supply_minimum_V) == is_before);
    CHECK((value(rows[i], Signal::duty_1) != 0 || value(rows[i], Signal::duty_2) != 0) == is_before);
  }
  CHECK(value(rows.front(), Signal::supply_V) > value(rows[box.rows_before - 1], Signal::supply_V) + 0.5f);
  // Checks the column of each signal while the arm rests against the hand.
  const double joint_1_rad = static_cast<double>(rig.pose().joint_rad[0]);
  CHECK(value(rows.back(), Signal::joint_1_rad) == doctest::Approx(joint_1_rad).epsilon(0.02));

  // The record survives a cleared fault, a second fault and a reset, until the force is switched on.
  rig.control.supply(static_cast<double>(board::supply_nominal_V));
  rig.run(0.3);
  rig.command(protocol::Command::clear_fault);
  rig.run_until([](const auto& pose) { return pose.state == State::ready; });
  rig.control.inject({"bridge_fault"});
  rig.run(0.3);
  rig.control.heal("bridge_fault");
  rig.control.reset();
  rig.control.dock(true);
  rig.control.hand({.holds = false});
  reconnect(rig);
  rig.run(0.3);
  CHECK(rig.device->black_box().fault == Fault::supply_low);
  CHECK(rig.device->black_box_rows(box).back().time_periods == rows.back().time_periods);
  rig.make_active();
  CHECK(rig.device->black_box().fault == Fault::none);
}

TEST_CASE("a processor fault leaves the rows before it and the address of the crash, over every reset that follows") {
  BoardRig rig;
  press_into_wall(rig);
  constexpr std::uint32_t nothing_there = 0x60000000;
  rig.control.inject({"program_astray", std::to_string(nothing_there)});
  rig.control.run(0.02);
  CHECK(restarts(rig.control) == 1);
  reconnect(rig);
  rig.run(0.3);
  const auto box = rig.device->black_box();
  CHECK(box.fault == Fault::processor_fault);
  // The fault is a BusFault, or a HardFault if the main loop has masked interrupts before it sleeps.
  CHECK((box.crash.exception == 5 || box.crash.exception == 3));
  CHECK(box.crash.program_counter == nothing_there);
  CHECK(box.crash.configurable_fault_status == 1u << 8);
  const auto rows = rig.device->black_box_rows(box);
  check_rows_until_crash(box, rows);

  rig.control.reset();
  reconnect(rig);
  rig.run(0.3);
  CHECK(rig.device->black_box().fault == Fault::processor_fault);
  CHECK(rig.device->black_box_rows(box).front().time_periods == rows.front().time_periods);

  rig.device.reset();
  rig.control.resume();
  const TemporaryDirectory directory;
  const auto address = rig.board.usbip().text();
  const auto shown = run_program("inkwell", {"fault", "--usbip", address});
  CHECK(shown.exit_code == 0);
  CHECK(shown.out.find("every signal around processor_fault") != std::string::npos);
  CHECK(shown.out.find("where the board restarted") != std::string::npos);
  CHECK(shown.out.find("it fetched an instruction from unmapped memory") != std::string::npos);
  CHECK(shown.out.find("at   0x60000000\n") != std::string::npos);
  CHECK(shown.out.find("`inkwell fault --elf FILE`") != std::string::npos);
  const auto image = std::filesystem::path(build_directory()) / ".." / "board" / "inkwell.elf";
  const auto named = run_program("inkwell", {"fault", "--usbip", address, "--elf", image.string()});
  INFO(named.out, named.err);
  CHECK(named.exit_code == 0);
  // The caller of main() is always on the stack. Main itself is not, if the link register belongs to a function that it
  // has called.
  CHECK(named.out.find(" start (startup.cpp:") != std::string::npos);
  const auto other_image = image.parent_path() / "force-law-magnet.elf";
  const auto refused = run_program("inkwell", {"fault", "--usbip", address, "--elf", other_image.string()});
  CHECK(refused.exit_code == 1);
  CHECK(refused.err.find("This ELF file has no checksum") != std::string::npos);
  const crash::FirmwareImage flashed(image);
  crash::require_image_of(box.crash, flashed);
  auto of_another = box.crash;
  of_another.image_check ^= 1;
  CHECK_THROWS_AS(crash::require_image_of(of_another, flashed), device::Error);
  const auto saved = run_program("inkwell", {"fault", "--usbip", address, "--out", directory.file("crash.h5")});
  INFO(saved.err);
  CHECK(saved.exit_code == 0);
}

TEST_CASE("a 3.3 V supply below the brown-out level is reported after the restart with the rows before the reset") {
  auto options = stepped_board(device::SimulationMode::exact, device::CyclePricing::likely);
  options.brown_out_level = 3;
  BoardRig rig(options);
  press_into_wall(rig);
  rig.control.inject({.fault = "logic_sag", .amount = 2.5, .for_s = 0.02});
  rig.control.run(0.05);
  REQUIRE(restarts(rig.control) > 0);
  reconnect(rig);
  rig.run(0.3);
  CHECK(rig.pose().fault == Fault::logic_supply_low);
  const auto box = rig.device->black_box();
  CHECK(box.fault == Fault::logic_supply_low);
  CHECK(box.crash.exception == 0);
  check_rows_until_crash(box, rig.device->black_box_rows(box));
  rig.command(protocol::Command::clear_fault);
  rig.run_until([](const auto& pose) { return pose.state == State::unreferenced; });
}

TEST_CASE("a crash while a black box is retained is reported with it, and a second crash replaces the first crash") {
  BoardRig rig;
  press_into_wall(rig);
  rig.control.inject({.fault = "bridge_fault", .for_s = 0.01});
  rig.run(0.2);
  const auto address = rig.board.usbip().text();
  const auto image = (std::filesystem::path(build_directory()) / ".." / "board" / "inkwell.elf").string();
  const auto output_of = [&](std::vector<std::string> more) {
    rig.device.reset();
    rig.control.resume();
    more.insert(more.begin(), {"fault", "--usbip", address});
    const auto shown = run_program("inkwell", more);
    INFO(shown.err);
    CHECK(shown.exit_code == 0);
    rig.control.stand_by();
    rig.connect();
    return shown.out;
  };
  CHECK(output_of({"--elf", image}).find("No firmware crash is recorded") != std::string::npos);
  for (const std::uint32_t astray : {0x60000000u, 0x64000000u}) {
    CAPTURE(astray);
    rig.control.inject({"program_astray", std::to_string(astray)});
    rig.control.run(0.02);
    reconnect(rig);
    rig.run(0.3);
    const auto box = rig.device->black_box();
    CHECK(box.fault == Fault::bridge_fault);
    CHECK(box.later_crashes == (astray == 0x60000000u ? 1 : 2));
    CHECK(box.crash.program_counter == astray);
    const std::string text = output_of({});
    CHECK(text.find("every signal around bridge_fault") != std::string::npos);
    CHECK(text.find(astray == 0x60000000u ? "After that fault the board restarted once."
                                          : "After that fault the board restarted 2 times") != std::string::npos);
    CHECK(text.find("it fetched an instruction from unmapped memory") != std::string::npos);
  }
}

TEST_CASE("a main loop that hangs leaves the rows before, and where it is") {
  BoardRig rig;
  press_into_wall(rig);
  const std::uint32_t loop = endless_loop_address();
  // The main loop runs directly after the control interrupt. Later the main loop may sleep with masked interrupts.
  const board::Pin heartbeat = board::find_board("omni_driver")->bridge_heartbeat;
  const std::string pin = std::string(1, 'P') + heartbeat.port + std::to_string(heartbeat.number);
  for (const std::string level : {"high", "low"})
    for (int step = 0; step < 60 && rig.control.pin(pin).level != level; ++step) rig.control.run(1e-6);
  rig.control.run(2e-6);
  rig.control.inject({"program_astray", std::to_string(loop)});
  rig.control.run(0.04);
  CHECK(watchdog_expires(rig.control) == 1);
  reconnect(rig);
  rig.run(0.3);
  CHECK(rig.pose().fault == Fault::watchdog);
  const auto box = rig.device->black_box();
  CHECK(box.fault == Fault::watchdog);
  CHECK(box.crash.exception == protocol::hang_exception);
  CHECK(box.crash.program_counter - loop <= 4);
  CHECK(box.crash.stack_pointer != 0);
  check_rows_until_crash(box, rig.device->black_box_rows(box));

  rig.device.reset();
  rig.control.resume();
  const auto image = (std::filesystem::path(build_directory()) / ".." / "board" / "inkwell.elf").string();
  const auto shown = run_program("inkwell", {"fault", "--usbip", rig.board.usbip().text(), "--elf", image});
  INFO(shown.out, shown.err);
  CHECK(shown.exit_code == 0);
  CHECK(shown.out.find("The main loop hung, and the watchdog expired.\n  at   0x") != std::string::npos);
  CHECK(shown.out.find(" main (main.cpp:") != std::string::npos);
}

TEST_CASE("where a main loop hung is kept for the watchdog alone, and not if it came back") {
  constexpr double longer_s = 1.2 * static_cast<double>(protocol::main_loop_stalled_s);
  BoardRig rig;
  press_into_wall(rig);
  rig.control.inject({"main_loop_stalled", "", longer_s});
  rig.run(0.2);
  REQUIRE(rig.device->black_box().fault == Fault::main_loop_stalled);
  const auto expect_no_crash_address = [&] {
    reconnect(rig);
    rig.run(0.3);
    const auto box = rig.device->black_box();
    CHECK(box.fault == Fault::main_loop_stalled);
    CHECK(box.later_crashes == 0);
    CHECK(box.crash.exception == 0);
  };
  // The watchdog expires while the core is stalled.
  rig.control.inject({"core_stalled", "", 0.04});
  rig.control.run(0.05);
  REQUIRE(watchdog_expires(rig.control) == 1);
  expect_no_crash_address();
  // An external reset occurs after the main loop hangs and before the watchdog expires.
  rig.control.inject({"main_loop_stalled", "", 10.0});
  rig.control.run(longer_s);
  REQUIRE(watchdog_expires(rig.control) == 1);
  rig.control.heal_all();
  rig.control.reset();
  expect_no_crash_address();
}
