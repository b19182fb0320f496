// The USB device decides which program is the driver.
#include <doctest/doctest.h>

#include "tests/firmware/usb/device_bench.hpp"

namespace inkwell::test {
namespace {

using protocol::ClaimOperation;
using protocol::Command;
using protocol::DriverReport;
using protocol::ReportId;
using protocol::RequestResult;

constexpr std::uint32_t first = 11, second = 22;
constexpr auto expiry_periods = static_cast<std::uint32_t>(protocol::claim_expiry_s * protocol::servo_rate_Hz);

struct DrivenBench : DeviceBench {
  explicit DrivenBench(std::uint32_t first_period = 0) : DeviceBench(first_period) {
    configure();
    run(1);  // removes the stop of the bus reset
    last_command.reset();
    claim(ClaimOperation::claim, first);
  }

  void claim(ClaimOperation operation, std::uint32_t number) {
    REQUIRE(set_report(3, claim_report(operation, number)) == done_result);
  }
  DriverReport driver() { return get_feature<DriverReport>(ReportId::driver); }

  /// Sends a command over the interrupt endpoint. Returns the command that the control interrupt carries out, if any.
  std::optional<Command> carried_out(Command kind, std::uint32_t claim, std::uint32_t ticket = 0,
                                     protocol::State state = protocol::State::ready) {
    last_command.reset();
    REQUIRE(port.out(1, bytes_of(command(kind, 1, claim, ticket))) == Handshake::ack);
    device.poll();
    run(1, state);
    return last_command ? std::optional(last_command->command) : std::nullopt;
  }
  std::optional<RequestResult> result_of(std::uint32_t ticket) {
    const auto report = get_feature<protocol::RequestResultsReport>(ReportId::request_results);
    for (const auto& entry : report.entries)
      if (entry.ticket == ticket) return entry.result;
    return std::nullopt;
  }
  /// Sends a heartbeat with this claim and returns true if the control interrupt accepts the heartbeat.
  bool keeps_alive(std::uint32_t claim) {
    link.commands.take_sign_of_life();
    REQUIRE(port.out(1, bytes_of(command(Command::heartbeat, 1, claim))) == Handshake::ack);
    device.poll();
    const bool heard = link.commands.take_sign_of_life();
    run(1);
    return heard;
  }
  bool accepts_force(std::uint32_t claim) {
    protocol::ForceReport force{};
    force.mode = protocol::ForceMode::beside_walls;
    force.interval_ms = 1;
    force.claim = claim;
    link.program.take_force();  // removes the request that ends the previous program's force
    REQUIRE(port.out(1, bytes_of(force)) == Handshake::ack);
    device.poll();
    const control::ForceTarget* target = link.program.take_force();
    return target != nullptr && target->mode != protocol::ForceMode::none;
  }
  protocol::Refusal refusal_of_parameter(std::uint32_t claim) {
    protocol::ParametersReport report{};
    report.claim = claim;
    report.count = 0;
    report.ticket = static_cast<std::uint16_t>(claim);
    REQUIRE(set_report(3, report, protocol::parameters_report_size(0)) == done_result);
    const auto result = get_feature<protocol::TransactionReport>(ReportId::transaction);
    CHECK(result.ticket == claim);
    run(1);
    return result.refusal;
  }
};

TEST_CASE("claim: the driver is named, and a second program has no effect until it takes over") {
  DrivenBench bench;
  const DriverReport driver = bench.driver();
  CHECK(driver.is_driven == 1);
  CHECK(driver.process_id == 1000 + first);
  CHECK(std::string_view(driver.program) == "trial");
  CHECK(driver.claim_digest == protocol::digest_of(first));
  CHECK(driver.changes == 1);

  bench.claim(ClaimOperation::claim, second);
  CHECK(bench.driver().process_id == 1000 + first);
  CHECK(bench.driver().refused == 1);
  bench.claim(ClaimOperation::release, second);
  CHECK(bench.driver().process_id == 1000 + first);

  bench.claim(ClaimOperation::take_over, second);
  CHECK(bench.driver().process_id == 1000 + second);
  CHECK(bench.driver().changes == 2);
  CHECK_FALSE(bench.accepts_force(first));
  CHECK(bench.accepts_force(second));
}

TEST_CASE("claim: commands, forces and parameters of another program are refused, but not its stop") {
  DrivenBench bench;
  for (const Command kind : {Command::enable_force, Command::disable_force, Command::clear_fault, Command::self_test,
                             Command::store_parameters, Command::factory_reset}) {
    CAPTURE(static_cast<int>(kind));
    CHECK_FALSE(bench.carried_out(kind, second, 100).has_value());
    CHECK(bench.result_of(100) == RequestResult::not_the_driver);
    CHECK(bench.carried_out(kind, first, 200) == kind);
    CHECK(bench.result_of(200) == RequestResult::carried_out);
  }
  CHECK(bench.carried_out(Command::stop, second, 300) == Command::stop);
  CHECK(bench.result_of(300) == RequestResult::carried_out);
  CHECK(bench.carried_out(Command::select_signals, second) == Command::select_signals);
  CHECK_FALSE(bench.accepts_force(second));
  CHECK_FALSE(bench.accepts_force(0));
  CHECK(bench.accepts_force(first));
  CHECK(bench.refusal_of_parameter(second) == protocol::Refusal::not_the_driver);
  CHECK(bench.refusal_of_parameter(first) == protocol::Refusal::accepted);
  bench.claim(ClaimOperation::release, first);
  CHECK(bench.refusal_of_parameter(second) == protocol::Refusal::accepted);
  CHECK_FALSE(bench.accepts_force(second));  // without a claim no program may send forces
}

TEST_CASE("claim: only the driver keeps the force on, and its claim ends when it falls silent") {
  DrivenBench bench;
  CHECK(bench.keeps_alive(first));
  CHECK_FALSE(bench.keeps_alive(second));
  CHECK_FALSE(bench.keeps_alive(0));
  bench.run(expiry_periods / 2);
  CHECK(bench.keeps_alive(first));
  bench.run(expiry_periods - 1);
  bench.device.poll();
  CHECK(bench.driver().is_driven == 1);
  bench.run(2);
  bench.device.poll();
  CHECK(bench.driver().is_driven == 0);
  CHECK(bench.driver().changes == 2);
  CHECK(bench.keeps_alive(second));
}

TEST_CASE("claim: it does not end where the count of control periods wraps, nor does a silent one survive that") {
  DrivenBench bench(0u - expiry_periods / 2);
  const bool is_heard = bench.keeps_alive(first);
  CHECK(is_heard);
  bench.run(expiry_periods - 2);
  bench.device.poll();
  CHECK(bench.driver().is_driven == 1);
  CHECK(bench.driver().time_periods < expiry_periods);
  bench.run(3);
  bench.device.poll();
  CHECK(bench.driver().is_driven == 0);
}

TEST_CASE("claim: the driving time of a program continues across the wrap of the period counter") {
  link::DriverClaim driver;
  std::uint32_t now_periods = 12'345;
  const auto request = claim_report(ClaimOperation::claim, first);
  driver.accept(bytes_of(request), now_periods);
  constexpr std::uint32_t seconds = 250'000;
  for (std::uint32_t i = 0; i < 2 * seconds; ++i) driver.pass_time(now_periods += protocol::servo_rate_Hz / 2);
  CHECK(driver.report(now_periods).driven_s == seconds);
  const auto other = claim_report(ClaimOperation::take_over, second);
  driver.accept(bytes_of(other), now_periods);
  CHECK(driver.report(now_periods).driven_s == 0);
  driver.end();
  driver.pass_time(now_periods += protocol::servo_rate_Hz);
  CHECK(driver.report(now_periods).driven_s == 0);
}

TEST_CASE("claim: a driver that releases the arm with the force on lets the force fall") {
  DrivenBench bench;
  bench.run(1, protocol::State::active);
  bench.last_command.reset();
  SUBCASE("release") { bench.claim(ClaimOperation::release, first); }
  SUBCASE("release while the queue is full") {
    for (std::uint32_t i = 0; i < link::CommandQueue::capacity; ++i)
      CHECK(bench.link.commands.push(command(Command::select_signals, 1)));
    bench.claim(ClaimOperation::release, first);
  }
  bool falls = false;
  for (std::uint32_t i = 0; i < 2 * link::CommandQueue::capacity; ++i) {
    bench.device.poll();
    bench.run(1, protocol::State::active);
    falls = falls || (bench.last_command && bench.last_command->command == Command::disable_force);
  }
  CHECK(falls);
  const control::ForceTarget* force = bench.link.program.take_force();
  REQUIRE(force != nullptr);
  CHECK(force->mode == protocol::ForceMode::none);
}

TEST_CASE("claim: a takeover leaves the force on, and ends force and shapes of the program before") {
  DrivenBench bench;
  bench.link.program.take_shapes();
  bench.link.program.take_force();
  bench.run(1, protocol::State::active);
  bench.last_command.reset();
  bench.claim(ClaimOperation::take_over, second);
  CHECK(bench.link.program.take_shapes() != nullptr);
  const control::ForceTarget* force = bench.link.program.take_force();
  REQUIRE(force != nullptr);
  CHECK(force->mode == protocol::ForceMode::none);
  bench.run(2, protocol::State::active);
  CHECK_FALSE(bench.last_command.has_value());
}

TEST_CASE("claim: a reset of the bus ends it") {
  DrivenBench bench;
  bench.port.reset();
  bench.device.poll();
  bench.configure();
  CHECK(bench.driver().is_driven == 0);
}

TEST_CASE("claim: a malformed report has no effect") {
  DrivenBench bench;
  auto report = claim_report(ClaimOperation::take_over, second);
  report.version = 1;
  CHECK(bench.set_report(3, report) == done_result);
  report = claim_report(ClaimOperation::take_over, 0);
  CHECK(bench.set_report(3, report) == done_result);
  report = claim_report(static_cast<ClaimOperation>(3), second);
  CHECK(bench.set_report(3, report) == done_result);
  report = claim_report(ClaimOperation::take_over, second);
  CHECK(bench.set_report(3, report, sizeof report - 1) == stall_result);
  CHECK(bench.driver().process_id == 1000 + first);
}

TEST_CASE("claim: poses show that the driver has changed, and nothing else that a pose had") {
  DrivenBench bench;
  bench.run(2);
  const auto parity = [&] {
    const ControlResult result = bench.get_report(1, 0x01, sizeof(protocol::PoseReport));
    REQUIRE(result.data.size() == sizeof(protocol::PoseReport));
    protocol::PoseReport pose;
    std::memcpy(&pose, result.data.data(), sizeof pose);
    return pose.driver_parity;
  };
  CHECK(parity() == 1);
  bench.claim(ClaimOperation::release, first);
  CHECK(parity() == 0);
}

TEST_CASE("a request result is waiting until the interrupt has executed the command, and is discarded with the host") {
  DrivenBench bench;
  REQUIRE(bench.port.out(1, bytes_of(command(Command::disable_force, 1, first, 5))) == Handshake::ack);
  bench.device.poll();
  CHECK(bench.result_of(5) == RequestResult::waiting);
  bench.run(1);
  CHECK(bench.result_of(5) == RequestResult::carried_out);
  for (std::uint32_t ticket = 10; ticket < 10 + protocol::request_results_kept; ++ticket)
    bench.carried_out(Command::disable_force, first, ticket);
  CHECK_FALSE(bench.result_of(5).has_value());
  CHECK(bench.result_of(10) == RequestResult::carried_out);
  bench.port.reset();
  bench.device.poll();
  bench.configure();
  CHECK_FALSE(bench.result_of(10).has_value());
}

}  // namespace
}  // namespace inkwell::test
