// Tests a host that sends commands faster than the control interrupt executes them.
#include <doctest/doctest.h>

#include "tests/firmware/usb/device_bench.hpp"

namespace inkwell {

using protocol::Command;
using test::bytes_of;
using test::command;
using test::done_result;
using test::Handshake;
using test::request;

namespace {

/// The device has a full queue and holds one additional command, enable_force. Tokens count up from 1.
struct FullQueue : test::DeviceBench {
  std::uint8_t token = 0;

  explicit FullQueue(const protocol::CommandReport& held = command(Command::enable_force, 9)) {
    configure();
    run(1);  // removes the stop of the bus reset
    for (std::uint32_t i = 0; i < link::CommandQueue::capacity; ++i)
      REQUIRE(offer(Command::heartbeat) == Handshake::ack);
    REQUIRE(port.out(1, bytes_of(held)) == Handshake::ack);
    device.poll();
    token = 9;
    REQUIRE(offer(Command::clear_fault) == Handshake::nak);
  }

  Handshake offer(Command kind) {
    const Handshake handshake = port.out(1, bytes_of(command(kind, static_cast<std::uint8_t>(token + 1))));
    if (handshake == Handshake::ack) ++token;
    device.poll();
    return handshake;
  }

  /// Lets the interrupt empty the queue and checks that all commands arrive in order.
  void check_nothing_was_lost() {
    CHECK(offer(Command::clear_fault) == Handshake::nak);
    run(1);
    CHECK(last_command->token == 1);
    device.poll();
    CHECK(offer(Command::clear_fault) == Handshake::ack);
    for (std::uint8_t taken = 2; taken <= token; ++taken) {
      run(1);
      device.poll();
      CHECK(last_command->token == taken);
    }
    CHECK(last_command->command == Command::clear_fault);
  }

  /// After a disconnection, the queued commands are discarded, and the endpoint accepts the next command.
  void check_all_is_forgotten() {
    device.poll();
    run(3);
    CHECK(last_command->command == Command::stop);
    CHECK(offer(Command::clear_fault) == Handshake::ack);
    run(1);
    CHECK(last_command->command == Command::clear_fault);
  }
};

}  // namespace

TEST_CASE("while the command queue is full, commands are answered with NAK, and no command is lost") {
  FullQueue bench;
  bench.check_nothing_was_lost();
}

TEST_CASE("a SET_REPORT command during a full queue is dropped, and its result is busy") {
  FullQueue bench;
  const auto send = [&](std::uint32_t ticket) {
    const protocol::CommandReport by_control = command(Command::clear_fault, 99, 0, ticket);
    CHECK(bench.set_report(2, by_control) == done_result);
    return bench.get_feature<protocol::RequestResultsReport>(protocol::ReportId::request_results).entries[0];
  };
  CHECK(send(0).ticket == 0);
  const auto dropped = send(77);
  CHECK(dropped.ticket == 77);
  CHECK(dropped.request == protocol::ReportId::command);
  CHECK(dropped.command == Command::clear_fault);
  CHECK(dropped.result == protocol::RequestResult::busy);
  bench.check_nothing_was_lost();
  bench.run(1);
  CHECK(bench.last_command->token != 99);
  send(0);
  bench.run(1);
  CHECK(bench.last_command->token == 99);
}

TEST_CASE("a held command survives that its endpoint starts again") {
  FullQueue configured;
  CHECK(configured.configure() == done_result);
  configured.check_nothing_was_lost();
  FullQueue let_go;
  CHECK(let_go.control(request(0x02, 1, 0, 0x01, 0)) == done_result);
  let_go.check_nothing_was_lost();
}

TEST_CASE("a held command is discarded when the host disconnects") {
  FullQueue asleep;
  asleep.port.suspend();
  asleep.device.poll();
  asleep.port.resume();
  asleep.check_all_is_forgotten();
  FullQueue reset;
  reset.port.reset();
  reset.device.poll();
  CHECK(reset.configure() == done_result);
  reset.check_all_is_forgotten();
}

TEST_CASE("a selection that finds the queue full waits for its turn with the others") {
  protocol::CommandReport selection = command(Command::select_signals, 9);
  selection.selection.count = 14;
  FullQueue bench(selection);
  bench.run(1000);
  CHECK(bench.link.scope.oldest_frame().empty());
  bench.device.poll();
  bench.run(1000);
  CHECK(bench.last_command->token == 9);
  CHECK_FALSE(bench.link.scope.oldest_frame().empty());
}

}  // namespace inkwell
