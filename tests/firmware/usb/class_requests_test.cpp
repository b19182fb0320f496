// Tests HID requests, firmware update requests, and requests for the device's reports.
#include <doctest/doctest.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <span>

#include "firmware/control/signal_path/installed_force_law.hpp"

#include "tests/firmware/link/transaction.hpp"
#include "tests/firmware/usb/device_bench.hpp"

namespace inkwell {

using test::answer;
using test::Bytes;
using test::bytes_of;
using test::claim_report;
using test::command;
using test::DeviceBench;
using test::done_result;
using test::Handshake;
using test::request;
using test::stall_result;

TEST_CASE("HID: idle rate is kept, boot protocol is refused") {
  DeviceBench bench;
  CHECK(bench.control(request(0x21, 10, 0x0400, 0, 0)) == stall_result);  // not configured
  bench.configure();
  CHECK(bench.control(request(0x21, 10, 0x0400, 0, 0)) == done_result);
  CHECK(bench.control(request(0xA1, 2, 0, 0, 1)) == answer({4}));
  CHECK(bench.control(request(0xA1, 2, 0, 2, 1)) == answer({0}));  // each interface has a separate idle rate
  CHECK(bench.control(request(0x21, 10, 0x0700, 2, 0)) == done_result);
  CHECK(bench.control(request(0xA1, 2, 0, 2, 1)) == answer({7}));
  CHECK(bench.control(request(0xA1, 2, 0, 0, 1)) == answer({4}));
  for (const std::uint16_t index : {0, 2}) {
    CHECK(bench.control(request(0x21, 11, 0, index, 0)) == stall_result);
    CHECK(bench.control(request(0xA1, 3, 0, index, 1)) == stall_result);
  }
  CHECK(bench.control(request(0x21, 10, 0, 1, 0)) == stall_result);  // the scope interface is not HID
}

TEST_CASE("HID: the host can request the controller report, but cannot send one") {
  DeviceBench bench;
  bench.configure();
  const auto ask = [&](std::uint16_t value) { return bench.control(request(0xA1, 1, value, 2, 64)); };
  CHECK(ask(0x0100) == answer({0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}));  // before the first period
  bench.run(101);
  CHECK(ask(0x0100) == answer({0xFF, 0x7F, 0, 0, 0, 0, 100, 0, 0, 0, 0, 0, 0, 0}));
  for (const unsigned value : {0x0101u, 0x0300u, 0x0200u})
    CHECK(ask(static_cast<std::uint16_t>(value)) == stall_result);
  CHECK(bench.control(request(0x21, 9, 0x0202, 2, sizeof(protocol::CommandReport))) == stall_result);
}

TEST_CASE("firmware update: the device leaves when the host has its answer, not before") {
  DeviceBench bench;
  const auto detach = request(0x21, 0, 1000, 3, 0);
  CHECK(bench.control(detach) == stall_result);  // not configured
  bench.configure();
  bench.run(1);
  CHECK(bench.control(request(0xA1, 5, 0, 3, 1)) == answer({0}));
  CHECK(bench.control(request(0xA1, 3, 0, 3, 6)) == answer({0, 0, 0, 0, 0, 0}));
  CHECK_FALSE(bench.device.leaves_for_update());
  CHECK_FALSE(bench.link.update_requested.load());
  bench.setup(detach);
  CHECK(bench.link.update_requested.load());  // from now on no command can switch the force on
  CHECK_FALSE(bench.device.leaves_for_update());
  CHECK(bench.status_in() == done_result);
  CHECK(bench.device.leaves_for_update());
  CHECK(bench.control(request(0xA1, 5, 0, 3, 1)) == answer({1}));
  CHECK(bench.control(request(0xA1, 3, 0, 3, 6)) == answer({0, 0, 0, 0, 1, 0}));
}

TEST_CASE("firmware update: with a force, or one about to come, a detach has no effect but the error errVENDOR") {
  DeviceBench bench;
  bench.configure();
  const auto detach = request(0x21, 0, 1000, 3, 0);
  const auto status = [&] { return bench.control(request(0xA1, 3, 0, 3, 6)); };
  const auto refused = answer({0x0B, 0, 0, 0, 0, 0});
  bench.run(1, protocol::State::active);
  CHECK(bench.control(detach) == done_result);
  CHECK(status() == refused);
  CHECK(status() == refused);  // reading does not clear the status
  CHECK(bench.control(request(0xA1, 5, 0, 3, 1)) == answer({0}));
  bench.port.reset();
  bench.device.poll();
  bench.configure();
  CHECK(status() == answer({0, 0, 0, 0, 0, 0}));
  bench.run(1);
  CHECK(bench.port.out(1, bytes_of(command(protocol::Command::enable_force, 1))) == Handshake::ack);
  bench.device.poll();
  CHECK(bench.control(detach) == done_result);
  CHECK(status() == refused);
  CHECK_FALSE(bench.device.leaves_for_update());
  CHECK_FALSE(bench.link.update_requested.load());
  bench.run(1);
  CHECK(bench.control(detach) == done_result);
  CHECK(status() == answer({0, 0, 0, 0, 1, 0}));
  CHECK(bench.device.leaves_for_update());
}

TEST_CASE("firmware update: a bus reset cancels it") {
  DeviceBench bench;
  bench.configure();
  const auto detach = request(0x21, 0, 1000, 3, 0);
  bench.run(1);
  bench.setup(detach);
  bench.port.reset();
  bench.device.poll();
  bench.configure();
  CHECK_FALSE(bench.device.leaves_for_update());
  CHECK_FALSE(bench.link.update_requested.load());
}

TEST_CASE("firmware update: other requests, directions and lengths are refused") {
  DeviceBench bench;
  bench.configure();
  bench.run(1);
  for (const unsigned number : {1u, 2u, 4u, 6u})
    CHECK(bench.control(request(0xA1, static_cast<std::uint8_t>(number), 0, 3, 6)) == stall_result);
  CHECK(bench.control(request(0xA1, 0, 0, 3, 1)) == stall_result);
  CHECK(bench.control(request(0x21, 5, 0, 3, 0)) == stall_result);
  CHECK(bench.control(request(0x21, 0, 0, 4, 0)) == stall_result);
  CHECK(bench.control(request(0x21, 0, 0, 1, 0)) == stall_result);
  CHECK_FALSE(bench.device.leaves_for_update());
}

TEST_CASE("HID: the host can request the newest pose") {
  DeviceBench bench;
  bench.configure();
  const auto read = [&] {
    const Bytes data = bench.get_report(1, 0x01, 64).data;
    REQUIRE(data.size() == sizeof(protocol::PoseReport));
    protocol::PoseReport pose;
    std::memcpy(&pose, data.data(), sizeof pose);
    return pose;
  };
  // Before the first control period, the pose report contains the state but no pose.
  const protocol::PoseReport first = read();
  const protocol::PoseReport expected{.state = protocol::State::starting};
  CHECK(std::memcmp(&first, &expected, sizeof first) == 0);
  bench.run(100);
  CHECK(read().time_periods == 99);
  CHECK(read().is_referenced == 1);
}

TEST_CASE("HID: the information report contains tables, clocks and counters") {
  DeviceBench bench;
  bench.configure();
  bench.run(5);
  bench.link.status.record(protocol::State::ready, {0.25f, 0.5f, 1.5f}, 4321, 0, true);
  const auto report = bench.get_feature<protocol::InformationReport>(protocol::ReportId::information);
  CHECK(report.report_id == protocol::ReportId::information);
  CHECK(report.version == protocol::protocol_version);
  CHECK(report.firmware_version[0] == 1);
  CHECK(report.firmware_version[2] == 3);
  CHECK(protocol::board_name(report.board) == "trial_board");
  CHECK(report.parameter_table_hash == protocol::parameter_table_hash);
  CHECK(report.signal_table_hash == protocol::signal_table_hash);

  // tests/host/client/device/force_law_test.cpp checks the content after the header.
  const auto law = bench.get_report(3, static_cast<std::uint8_t>(protocol::ReportId::force_law), 2048).data;
  const auto& installed = control::installed_force_law;
  REQUIRE(law.size() == 2048);
  CHECK(std::equal(installed.report, installed.report + installed.report_size, law.begin()));
  CHECK(report.servo_rate_Hz == 20'000);
  CHECK(report.processor_clock_Hz == 168'000'000);
  CHECK(report.servo_cycles_longest == 4321);
  CHECK(report.servo_overruns == 1);
  CHECK(report.scope_samples_dropped == 0);
  CHECK(report.pose_reports_dropped == 0);
  CHECK(report.reset_cause == 0x14);
  CHECK(report.image_check == 0x600DC0DE);
  CHECK(report.motor_heat[0] == 0.25f);
  CHECK(report.motor_heat[2] == 1.5f);
}

TEST_CASE("HID: the host reads parameters, sets them in a transaction and reads the result") {
  DeviceBench bench;
  bench.configure();
  const test::Transaction transaction{test::entry(protocol::Parameter::wall_stiffness_N_per_m, 321.0f),
                                      test::entry(protocol::Parameter::wall_damping_Ns_per_m, 4.0f)};
  CHECK(bench.control(request(0x21, 9, 0x0311, 0, 28), transaction.bytes()) == done_result);
  bench.run(3);
  auto result = bench.get_feature<protocol::TransactionReport>(protocol::ReportId::transaction);
  CHECK(result.refusal == protocol::Refusal::accepted);
  CHECK(result.transactions == 1);
  CHECK(result.applied_at_periods == 0);

  const auto report = bench.get_feature<protocol::ParametersReport>(protocol::ReportId::parameters);
  CHECK(report.count == protocol::parameter_count);
  const auto row = static_cast<std::size_t>(protocol::Parameter::wall_stiffness_N_per_m);
  const float value = report.entries[row].value;
  CHECK(value == 321.0f);

  // The device accepts the transfer and refuses the transaction. The transaction report shows the refusal.
  const test::Transaction bad{{9999, 0, 1.0f}};
  CHECK(bench.control(request(0x21, 9, 0x0311, 0, 20), bad.bytes()) == done_result);
  result = bench.get_feature<protocol::TransactionReport>(protocol::ReportId::transaction);
  CHECK(result.refusal == protocol::Refusal::unknown_parameter);
  CHECK(result.parameter_id == 9999);
  CHECK(result.transactions == 2);
}

TEST_CASE("HID: the arm does not change while the force is on or about to be") {
  DeviceBench bench;
  bench.configure();
  const test::Transaction transaction{test::entry(protocol::Parameter::link_2_m, 0.2f)};
  const auto refusal = [&] {
    bench.control(request(0x21, 9, 0x0311, 0, 20), transaction.bytes());
    bench.run(1);
    return bench.get_feature<protocol::TransactionReport>(protocol::ReportId::transaction).refusal;
  };
  bench.run(1, protocol::State::active);
  CHECK(refusal() == protocol::Refusal::force_is_on);
  bench.run(1, protocol::State::ready);
  // The command is in the queue, and the interrupt has not carried it out yet.
  CHECK(bench.set_report(2, command(protocol::Command::enable_force, 1)) == done_result);
  CHECK(refusal() == protocol::Refusal::force_is_on);
  CHECK(refusal() == protocol::Refusal::accepted);
}

TEST_CASE("HID: commands come by the interrupt endpoint and by SET_REPORT") {
  DeviceBench bench;
  bench.configure();
  CHECK(bench.port.out(1, bytes_of(command(protocol::Command::clear_fault, 11))) == Handshake::ack);
  bench.device.poll();
  bench.run(2);  // the first command is the stop from the bus reset
  REQUIRE(bench.last_command.has_value());
  CHECK(bench.last_command->token == 11);
  CHECK(bench.link.commands.take_sign_of_life());

  CHECK(bench.set_report(2, command(protocol::Command::disable_force, 12)) == done_result);
  bench.run(1);
  CHECK(bench.last_command->token == 12);
  CHECK(bench.last_command->command == protocol::Command::disable_force);
}

TEST_CASE("HID: a command with values that are not allowed is dropped, and its result is malformed") {
  DeviceBench bench;
  bench.configure();
  bench.run(1);  // removes the stop of the bus reset
  bench.last_command.reset();
  const auto results = [&] {
    return bench.get_feature<protocol::RequestResultsReport>(protocol::ReportId::request_results);
  };
  protocol::CommandReport wrong = command(protocol::Command::test_current, 1, 0, 50);
  wrong.test = {.motor = 4, .amplitude = 0.1f, .duration_s = 0.01f};
  CHECK(bench.set_report(2, wrong) == done_result);
  CHECK(results().entries[0].ticket == 50);
  CHECK(results().entries[0].result == protocol::RequestResult::malformed);
  wrong = command(static_cast<protocol::Command>(11), 1, 0, 51);
  REQUIRE(bench.port.out(1, bytes_of(wrong)) == Handshake::ack);
  bench.device.poll();
  CHECK(results().entries[1].ticket == 51);
  CHECK(results().entries[1].result == protocol::RequestResult::malformed);
  wrong.ticket = 52;
  wrong.version = protocol::protocol_version + 1;  // with another version no field is used
  CHECK(bench.set_report(2, wrong) == done_result);
  CHECK(results().entries[2].ticket == 0);
  bench.run(2);
  CHECK_FALSE(bench.last_command.has_value());
}

TEST_CASE("HID: a program's forces come by the interrupt endpoint and by SET_REPORT, and are signs of life") {
  DeviceBench bench;
  bench.configure();
  bench.run(1);  // removes the stop of the bus reset
  protocol::ForceReport force{};
  force.mode = protocol::ForceMode::beside_walls;
  force.interval_ms = 1;
  force.force_N[1] = 0.5f;
  force.claim = 7;
  REQUIRE(bench.set_report(3, claim_report(protocol::ClaimOperation::claim, 7)) == done_result);
  bench.link.program.take_force();  // removes the empty request of the bus reset
  for (std::uint32_t sequence = 0; sequence < 20; ++sequence) {
    force.sequence = sequence;
    REQUIRE(bench.port.out(1, bytes_of(force)) == Handshake::ack);
    bench.device.poll();
    CHECK(bench.link.commands.take_sign_of_life());
    const control::ForceTarget* target = bench.link.program.take_force();
    REQUIRE(target != nullptr);
    CHECK(target->force_N.y == 0.5f);
  }
  force.sequence = 22;
  CHECK(bench.set_report(2, force) == done_result);
  CHECK(bench.link.program.take_force() != nullptr);

  force.force_N[0] = std::numeric_limits<float>::quiet_NaN();
  bench.link.commands.take_sign_of_life();
  REQUIRE(bench.port.out(1, bytes_of(force)) == Handshake::ack);
  bench.device.poll();
  CHECK_FALSE(bench.link.commands.take_sign_of_life());
  CHECK(bench.link.program.take_force() == nullptr);
  bench.link.status.record(protocol::State::ready, {}, 100, 3, false);
  const auto information = bench.get_feature<protocol::InformationReport>(protocol::ReportId::information);
  CHECK(information.force_reports == 22);
  CHECK(information.force_reports_lost == 2);
  CHECK(information.force_reports_late == 3);
  CHECK(information.force_reports_refused == 1);
}

TEST_CASE("HID: shapes are accepted or refused as a whole, their result has their ticket, and they end with the host") {
  DeviceBench bench;
  bench.configure();
  bench.link.program.take_shapes();  // removes the empty request of the bus reset
  protocol::ShapesReport shapes{};
  shapes.plane_count = protocol::shape_planes_maximum;
  shapes.claim = 7;
  shapes.ticket = 100;
  const auto result = [&] {
    ++shapes.ticket;
    CHECK(bench.set_report(3, shapes) == done_result);
    const auto report = bench.get_feature<protocol::RequestResultsReport>(protocol::ReportId::request_results);
    const auto* entry = std::ranges::find(report.entries, shapes.ticket, &protocol::RequestResultEntry::ticket);
    REQUIRE(entry != std::end(report.entries));
    CHECK(entry->request == protocol::ReportId::shapes);
    return entry->result;
  };
  CHECK(result() == protocol::RequestResult::not_the_driver);
  REQUIRE(bench.set_report(3, claim_report(protocol::ClaimOperation::claim, 7)) == done_result);
  bench.link.program.take_force();  // removes the empty request of the bus reset
  for (auto& plane : shapes.planes) plane = {{0, 0, 0}, {0, 0, 1}, {800.0f, 1.0f, 0.0f, 0.0f, 0.0f, 1.0f}};
  CHECK(result() == protocol::RequestResult::accepted);
  CHECK(result() == protocol::RequestResult::busy);  // the interrupt has not accepted the previous shapes
  const control::Shapes* taken = bench.link.program.take_shapes();
  REQUIRE(taken != nullptr);
  CHECK(taken->life_periods[7] != 0);
  shapes.planes[7].normal[2] = 0.0f;
  CHECK(result() == protocol::RequestResult::malformed);
  CHECK(bench.link.program.take_shapes() == nullptr);
  CHECK(bench.configure(0) == done_result);
  taken = bench.link.program.take_shapes();
  REQUIRE(taken != nullptr);
  CHECK(taken->life_periods[7] == 0);
}

TEST_CASE("HID: the black box is read row by row, as often as the host likes") {
  DeviceBench bench;
  bench.configure();
  const auto head = [&] { return bench.get_feature<protocol::BlackBoxReport>(protocol::ReportId::black_box); };
  bench.run(30);
  CHECK(head().fault == protocol::Fault::none);
  CHECK(bench.get_feature<protocol::BlackBoxRowsReport>(protocol::ReportId::black_box_rows).row_count == 0);

  bench.run(100, protocol::State::fault, protocol::Fault::supply_low);
  CHECK(head().fault == protocol::Fault::supply_low);
  CHECK(head().fault_periods == 30);
  CHECK(head().rows_before == 2);
  REQUIRE(head().row_count == 6);
  std::uint32_t expected[] = {0, 20, 30, 50, 70, 90};
  for (std::uint16_t row = 0; row < 6; ++row) {
    const protocol::BlackBoxRequest request{.first_row = row};
    CHECK(bench.set_report(3, request) == done_result);
    for (int i = 0; i < 2; ++i) {
      const auto report = bench.get_feature<protocol::BlackBoxRowsReport>(protocol::ReportId::black_box_rows);
      CHECK(report.first_row == row);
      CHECK(static_cast<protocol::RequestResult>(report.result) == protocol::RequestResult::accepted);
      CHECK(report.row_count == std::min<std::size_t>(protocol::black_box_report_rows, 6u - row));
      const std::uint32_t period = report.rows[0].time_periods;
      CHECK(period == expected[row]);
      const float position_m = report.rows[0].values[static_cast<std::size_t>(protocol::Signal::position_x_m)];
      CHECK(position_m == static_cast<float>(period));
    }
  }
  // The device accepts the transfer and refuses the request. The report shows the refusal, and the selected rows do not
  // change.
  const protocol::BlackBoxRequest request{.version = protocol::protocol_version - 1, .first_row = 0};
  CHECK(bench.set_report(3, request) == done_result);
  const auto refused = bench.get_feature<protocol::BlackBoxRowsReport>(protocol::ReportId::black_box_rows);
  CHECK(static_cast<protocol::RequestResult>(refused.result) == protocol::RequestResult::malformed);
  CHECK(refused.first_row == 5);

  bench.run(1, protocol::State::active);
  CHECK(head().fault == protocol::Fault::none);
}

TEST_CASE("HID: the self-test report contains the results of start-up") {
  DeviceBench bench;
  bench.configure();
  bench.link.self_test.note(protocol::SelfTestItem::ram, false);
  bench.link.self_test.note(protocol::SelfTestItem::gimbal_3, true, 0.25f);
  const auto report = bench.get_feature<protocol::SelfTestReport>(protocol::ReportId::self_test);
  CHECK(report.report_id == protocol::ReportId::self_test);
  CHECK(report.item_count == protocol::self_test_item_count);
  CHECK(report.entries[static_cast<std::size_t>(protocol::SelfTestItem::ram)].result ==
        protocol::SelfTestResult::failed);
  CHECK(report.entries[static_cast<std::size_t>(protocol::SelfTestItem::gimbal_3)].figure == 0.25f);
  CHECK(protocol::takes_force(report));
}

TEST_CASE("HID: a command to the store is counted, and refused while a force may come") {
  DeviceBench bench;
  bench.configure();
  const auto report = [&] { return bench.get_feature<protocol::StoreReport>(protocol::ReportId::store); };
  CHECK(report().result == protocol::StoreResult::none);
  const auto send = [&](protocol::Command what) { CHECK(bench.set_report(2, command(what, 1)) == done_result); };
  bench.run(1, protocol::State::active);
  send(protocol::Command::store_parameters);
  CHECK(report().result == protocol::StoreResult::force_is_on);
  bench.run(1, protocol::State::ready);
  send(protocol::Command::enable_force);  // is in the queue before the next command
  send(protocol::Command::store_parameters);
  CHECK(report().result == protocol::StoreResult::force_is_on);
  bench.run(5, protocol::State::ready);
  send(protocol::Command::store_parameters);
  CHECK(report().result == protocol::StoreResult::under_way);
  CHECK(report().commands == 3);
}

TEST_CASE("HID: reports with a wrong id, type or length are refused or ignored, and nothing happens") {
  DeviceBench bench;
  bench.configure();
  bench.run(1);  // removes the stop of the bus reset
  bench.last_command.reset();
  const protocol::CommandReport good = command(protocol::Command::enable_force, 1);

  for (unsigned type = 0; type < 5; ++type)
    for (unsigned id = 0; id < 256; ++id) {
      const auto value = static_cast<std::uint16_t>(type << 8 | id);
      if (value == 0x0202 || value == 0x0203 || value == 0x0204 || value == 0x0311 || value == 0x0314 ||
          value == 0x0317 || value == 0x031B)
        continue;
      bench.setup(request(0x21, 9, value, 0, sizeof good));
      CHECK(bench.port.out(0, bytes_of(good)) == Handshake::stall);
    }
  // The id in the data differs from the id in the request.
  CHECK(bench.control(request(0x21, 9, 0x0311, 0, sizeof good), bytes_of(good)) == stall_result);
  // Reports that are too short or too long are refused.
  for (const std::size_t size : {1u, 44u}) CHECK(bench.set_report(2, good, size) == stall_result);
  const std::array<std::byte, 65> longer{std::byte{2}};
  CHECK(bench.set_report(2, longer) == stall_result);
  for (const std::size_t size : {0u, 1u, 44u}) {
    std::array<std::byte, 64> packet{};
    std::memcpy(packet.data(), &good, sizeof good);
    CHECK(bench.port.out(1, std::span(packet).first(size)) == Handshake::ack);
    bench.device.poll();
  }
  bench.run(5);
  CHECK_FALSE(bench.last_command.has_value());
  CHECK_FALSE(bench.link.commands.take_sign_of_life());

  for (unsigned type = 0; type < 5; ++type)
    for (unsigned id = 0; id < 256; ++id) {
      const unsigned value = type << 8 | id;
      if (value == 0x0101 || value == 0x0310 || value == 0x0311 || value == 0x0312 || value == 0x0313 ||
          value == 0x0315 || value == 0x0316 || value == 0x0317 || value == 0x0318 || value == 0x0319 ||
          value == 0x031A || value == 0x031B || value == 0x031C)
        continue;
      CHECK(bench.get_report(static_cast<std::uint8_t>(type), static_cast<std::uint8_t>(id), 64) == stall_result);
    }
  CHECK(bench.control(request(0xA1, 1, 0x0310, 1, 64)) == stall_result);
}

}  // namespace inkwell
