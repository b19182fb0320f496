// The flashed firmware stores its parameters in the flash of the virtual chip: they outlive the power, which may fail
// at any word, and neither control interrupt nor poses nor watchdog are held up.
#include <doctest/doctest.h>

#include <cstring>
#include <optional>
#include <utility>
#include <vector>

#include <protocol/store.hpp>

#include "firmware_on_bus.hpp"

namespace inkwell::virtual_usb_test {
namespace {

using protocol::Command;
using protocol::Parameter;
using protocol::ReportId;
using protocol::StoreContents;
using protocol::StoreResult;
using virtual_board::ChipOptions;
using virtual_board::ResetCause;

constexpr float default_stiffness = 800.0f;

struct StoringBoard {
  explicit StoringBoard(const ChipOptions& options = {}) : bus(flashed_image(), 0.0, options) {
    bus.chip.on_reset = [this](ResetCause cause) {
      if (cause == ResetCause::power_on) trial_is_due = true;
      if (cause == ResetCause::independent_watchdog) resets += std::exchange(trial_is_due, false) ? 0 : 1;
    };
  }

  void start() {
    bus.connect();
    bus.run_for(0.35);  // the self-test, which runs after the start
  }
  void switch_off_and_on() {
    bus.plug(false);
    bus.chip.reset(ResetCause::power_on);
    bus.run_for(0.01);
    bus.plug(true);
    start();
  }
  template <class Report>
  Report get(ReportId id) {
    Report report{};
    const auto answer =
        bus.control(0xA1, 1, static_cast<std::uint16_t>(0x0300 | static_cast<int>(id)), 0, sizeof report);
    REQUIRE(answer.data.size() <= sizeof report);
    std::memcpy(&report, answer.data.data(), answer.data.size());
    return report;
  }
  protocol::StoreReport report() { return get<protocol::StoreReport>(ReportId::store); }
  float held(Parameter parameter, ReportId of = ReportId::parameters) {
    return get<protocol::ParametersReport>(of).entries[static_cast<std::size_t>(parameter)].value;
  }
  float stiffness() { return held(Parameter::wall_stiffness_N_per_m); }
  void transact(protocol::ParameterOperation operation, std::vector<std::pair<Parameter, float>> values) {
    protocol::ParametersReport report{};
    report.operation = operation;
    for (const auto& [parameter, value] : values)
      report.entries[report.count++] = {protocol::info(parameter).id, 0, value};
    const std::size_t size = protocol::parameters_report_size(report.count);
    std::vector<std::byte> data(size);
    std::memcpy(data.data(), &report, size);
    bus.control(0x21, 9, 0x0311, 0, static_cast<std::uint16_t>(size), data);
    bus.run_for(0.001);
  }
  void set_stiffness(float value) {
    transact(protocol::ParameterOperation::set, {{Parameter::wall_stiffness_N_per_m, value}});
  }
  void send(Command command) {
    const protocol::CommandReport report{.command = command, .token = ++token};
    bus.send_report(report);
  }
  StoreResult carry_out(Command command) {
    send(command);
    bus.run_for(0.15);
    return report().result;
  }

  FirmwareOnBus bus;
  bool trial_is_due = true;  ///< of the watchdog, when the power has come
  unsigned resets = 0;       ///< by the watchdog at other times
  std::uint8_t token = 0;
};

}  // namespace

TEST_CASE("parameters that were stored hold after the power was off; others do not; a factory reset forgets them") {
  StoringBoard board;
  board.start();
  CHECK(board.report().contents == StoreContents::nothing);
  CHECK(board.report().differing == 0);
  board.set_stiffness(500.0f);
  CHECK(board.report().differing == 1);
  board.switch_off_and_on();
  CHECK(board.stiffness() == default_stiffness);

  board.set_stiffness(500.0f);
  CHECK(board.carry_out(Command::store_parameters) == StoreResult::done);
  protocol::StoreReport report = board.report();
  CHECK(report.contents == StoreContents::parameters);
  CHECK(report.contents_at_start == StoreContents::nothing);
  CHECK(report.differing == 0);
  CHECK(report.commands == 1);
  CHECK(report.records_written == 1);
  const auto stores_left = report.stores_left;
  board.switch_off_and_on();
  CHECK(board.stiffness() == 500.0f);
  report = board.report();
  CHECK(report.contents_at_start == StoreContents::parameters);
  CHECK(report.parameter_table_hash == protocol::parameter_table_hash);
  CHECK(report.entries == protocol::parameter_count);
  CHECK(report.schema == protocol::store_schema);
  CHECK(report.unknown == 0);
  CHECK(report.out_of_range == 0);
  CHECK(report.stores_left == stores_left);

  // The same again takes no room; another value does.
  CHECK(board.carry_out(Command::store_parameters) == StoreResult::done);
  CHECK(board.report().records_written == 1);
  board.set_stiffness(600.0f);
  CHECK(board.held(Parameter::wall_stiffness_N_per_m, ReportId::stored) == 500.0f);
  board.transact(protocol::ParameterOperation::restore_stored, {});
  CHECK(board.stiffness() == 500.0f);
  CHECK(board.carry_out(Command::factory_reset) == StoreResult::done);
  CHECK(board.stiffness() == default_stiffness);
  CHECK(board.report().contents == StoreContents::factory_reset);
  board.switch_off_and_on();
  CHECK(board.stiffness() == default_stiffness);
  CHECK(board.report().contents_at_start == StoreContents::factory_reset);
  CHECK(board.carry_out(Command::factory_reset) == StoreResult::nothing_stored);
  CHECK(board.resets == 0);
  CHECK(board.bus.violations() == std::vector<std::string>{});
}

TEST_CASE("nothing is stored while the board tests itself") {
  StoringBoard board;
  board.start();
  board.send(Command::self_test);
  board.send(Command::store_parameters);
  board.bus.run_for(0.1);
  CHECK(board.report().result == StoreResult::force_is_on);
  CHECK(board.report().records_written == 0);
}

TEST_CASE("a power cut at every word of a store leaves the old parameters or the new ones") {
  std::vector<std::uint8_t> old_flash;
  std::uint64_t words = 0;
  {
    StoringBoard board;
    board.start();
    board.set_stiffness(500.0f);
    REQUIRE(board.carry_out(Command::store_parameters) == StoreResult::done);
    old_flash.assign(board.bus.chip.flash().begin(), board.bus.chip.flash().end());
    board.set_stiffness(600.0f);
    const std::uint64_t before = board.bus.chip.flash_operations();
    REQUIRE(board.carry_out(Command::store_parameters) == StoreResult::done);
    words = board.bus.chip.flash_operations() - before;
  }
  REQUIRE(words > 2 * protocol::parameter_count);
  // Some of them; tests/firmware/link/flash_log_test.cpp takes each.
  std::vector<std::uint64_t> cuts{1, 2, words - 1, words};
  for (std::uint64_t cut = 7; cut < words; cut += words / 5) cuts.push_back(cut);
  for (const std::uint64_t cut : cuts) {
    CAPTURE(cut);
    StoringBoard board({.random_seed = static_cast<std::uint32_t>(cut)});
    std::memcpy(board.bus.chip.flash().data(), old_flash.data(), old_flash.size());
    board.bus.chip.reset(ResetCause::power_on);
    board.start();
    REQUIRE(board.stiffness() == 500.0f);
    board.set_stiffness(600.0f);
    board.bus.chip.cut_power_at_flash_operation(cut);
    board.send(Command::store_parameters);
    board.bus.run_for(0.15);
    board.switch_off_and_on();
    const float found = board.stiffness();
    CHECK((found == 500.0f || (found == 600.0f && cut == words)));
    CHECK(board.report().contents_at_start == StoreContents::parameters);
    board.set_stiffness(700.0f);
    REQUIRE(board.carry_out(Command::store_parameters) == StoreResult::done);
    board.switch_off_and_on();
    CHECK(board.stiffness() == 700.0f);
  }
}

TEST_CASE("neither the control interrupt nor the poses are held up by a store, however slow the flash is") {
  for (const bool slowest : {false, true}) {
    CAPTURE(slowest);
    StoringBoard board({.slowest_flash = slowest});
    board.start();
    board.set_stiffness(500.0f);
    Ticks last = 0, longest = 0;
    board.bus.on_pose = [&](const protocol::PoseReport&) {
      if (last != 0) longest = std::max(longest, board.bus.chip.now() - last);
      last = board.bus.chip.now();
    };
    board.bus.keep_asking_for_poses();
    board.bus.run_for(0.02);
    REQUIRE(longest > 0);
    longest = 0;
    CHECK(board.carry_out(Command::store_parameters) == StoreResult::done);
    // A millisecond each; what the bus does in it may move a pose within its frame.
    CHECK(longest < ticks(0.0021));
    const auto information = board.get<protocol::InformationReport>(ReportId::information);
    CHECK(information.servo_overruns == 0);
    CHECK(information.pose_reports_dropped == 0);
    CHECK(board.resets == 0);
  }
}

TEST_CASE("a start that has to erase takes so much longer, and no watchdog bites, on the slowest flash") {
  StoringBoard board({.low_speed_internal_Hz = 47'000, .slowest_flash = true});
  constexpr std::size_t second_sector = 0xC000;
  board.bus.chip.flash()[second_sector + 100] = 0;  // what an erase that was cut off has left
  board.bus.chip.reset(ResetCause::power_on);
  board.bus.plug(false);
  board.bus.run_for(0.6);
  board.bus.plug(true);
  board.start();
  CHECK(board.bus.chip.flash()[second_sector + 100] == 0xFF);
  CHECK(board.report().sector_erases[1] == 1);
  CHECK(board.resets == 0);
  board.set_stiffness(500.0f);
  CHECK(board.carry_out(Command::store_parameters) == StoreResult::done);
  CHECK(board.get<protocol::InformationReport>(ReportId::information).servo_overruns == 0);
}

}  // namespace inkwell::virtual_usb_test
