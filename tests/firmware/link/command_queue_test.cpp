#include <doctest/doctest.h>

#include <algorithm>
#include <cstring>
#include <limits>

#include "firmware/link/command_queue.hpp"

namespace inkwell {

using link::CommandQueue;
using link::decode_command;
using protocol::Command;
using protocol::CommandReport;

namespace {

CommandReport make(Command command, std::uint8_t token = 0) {
  CommandReport report{};
  report.command = command;
  report.token = token;
  return report;
}

bool is_accepted(const CommandReport& report) {
  return decode_command(std::as_bytes(std::span(&report, 1))).has_value();
}

}  // namespace

TEST_CASE("valid commands are decoded unchanged") {
  for (const Command command :
       {Command::heartbeat, Command::enable_force, Command::disable_force, Command::clear_fault, Command::stop}) {
    const CommandReport report = make(command, 77);
    const auto decoded = decode_command(std::as_bytes(std::span(&report, 1)));
    REQUIRE(decoded.has_value());
    CHECK(std::memcmp(&*decoded, &report, sizeof report) == 0);
  }
}

TEST_CASE("a command may be padded, and a command of another length, report, version or kind is ignored") {
  const CommandReport good = make(Command::enable_force);
  std::byte longer[65]{};
  std::memcpy(longer, &good, sizeof good);
  for (std::size_t size = 0; size <= sizeof longer; ++size)
    CHECK(decode_command(std::span(longer).first(size)).has_value() == (size >= sizeof good && size <= 64));

  CommandReport bad = good;
  bad.version = protocol::protocol_version + 1;
  CHECK_FALSE(is_accepted(bad));
  bad = good;
  bad.report_id = protocol::ReportId::pose;
  CHECK_FALSE(is_accepted(bad));
  for (int command = static_cast<int>(Command::factory_reset) + 1; command < 256; ++command)
    CHECK_FALSE(is_accepted(make(static_cast<Command>(command))));
}

TEST_CASE("a selection contains only known signals, up to the maximum number") {
  CommandReport report = make(Command::select_signals);
  CHECK(is_accepted(report));  // an empty selection stops the scope
  report.selection.count = protocol::scope_signals_maximum;
  for (std::uint8_t& signal : report.selection.signals) signal = protocol::signal_count - 1;
  CHECK(is_accepted(report));
  report.selection.signals[31] = protocol::signal_count;
  CHECK_FALSE(is_accepted(report));
  report.selection.count = 31;
  CHECK(is_accepted(report));  // entries after `count` are not checked
  report.selection.count = protocol::scope_signals_maximum + 1;
  CHECK_FALSE(is_accepted(report));
  report.selection.count = 254;
  CHECK_FALSE(is_accepted(report));
  report.selection.count = protocol::selected_by_mask;
  std::ranges::fill(report.selection.signals, std::uint8_t{0});
  CHECK_FALSE(is_accepted(report));  // an empty mask
  report.selection.signals[(protocol::signal_count - 1) / 8] = 1u << (protocol::signal_count - 1) % 8;
  CHECK(is_accepted(report));
  report.selection.signals[protocol::signal_count / 8] |= 1u << protocol::signal_count % 8;
  CHECK_FALSE(is_accepted(report));
}

TEST_CASE("a test pulse names a motor and has finite numbers") {
  for (const Command command : {Command::test_current, Command::test_voltage}) {
    CommandReport good = make(command);
    good.test = {2, -0.5f, 0.1f};
    CHECK(is_accepted(good));
    for (const int motor : {0, 4, 255}) {
      CommandReport bad = good;
      bad.test.motor = static_cast<std::uint8_t>(motor);
      CHECK_FALSE(is_accepted(bad));
    }
    const float infinity = std::numeric_limits<float>::infinity();
    const float not_a_number = std::numeric_limits<float>::quiet_NaN();
    for (const float amplitude : {infinity, -infinity, not_a_number}) {
      CommandReport bad = good;
      bad.test.amplitude = amplitude;
      CHECK_FALSE(is_accepted(bad));
    }
    for (const float duration_s : {-0.001f, 0.501f, infinity, not_a_number}) {
      CommandReport bad = good;
      bad.test.duration_s = duration_s;
      CHECK_FALSE(is_accepted(bad));
    }
  }
}

TEST_CASE("commands come out in order, one a period, and their tokens with them") {
  CommandQueue queue;
  CHECK(queue.pop() == nullptr);
  CHECK_FALSE(queue.take_sign_of_life());
  // The commands wrap around the ring several times.
  std::uint8_t next = 0;
  for (int round = 0; round < 10; ++round) {
    for (int i = 0; i < 3; ++i) CHECK(queue.push(make(Command::heartbeat, static_cast<std::uint8_t>(next + i))));
    CHECK(queue.take_sign_of_life());
    CHECK_FALSE(queue.take_sign_of_life());
    for (int i = 0; i < 3; ++i) {
      const CommandReport* command = queue.pop();
      REQUIRE(command != nullptr);
      CHECK(command->token == next);
      CHECK(queue.last_token() == next);
      ++next;
    }
    CHECK(queue.pop() == nullptr);
  }
}

TEST_CASE("a full queue refuses a command, retains the queued commands and records the sign of life") {
  CommandQueue queue;
  for (std::uint32_t i = 0; i < CommandQueue::capacity; ++i)
    CHECK(queue.push(make(Command::heartbeat, static_cast<std::uint8_t>(i))));
  CHECK_FALSE(queue.has_room());
  queue.take_sign_of_life();
  CHECK_FALSE(queue.push(make(Command::enable_force, 99)));
  CHECK(queue.take_sign_of_life());
  CHECK_FALSE(queue.waiting(Command::enable_force));
  CHECK(queue.pop() != nullptr);
  CHECK(queue.has_room());
  for (std::uint32_t i = 1; i < CommandQueue::capacity; ++i) CHECK(queue.pop()->token == i);
  CHECK(queue.pop() == nullptr);
}

TEST_CASE("a waiting command is reported until it is removed") {
  CommandQueue queue;
  CHECK(queue.push(make(Command::heartbeat)));
  CHECK(queue.push(make(Command::enable_force)));
  CHECK(queue.waiting(Command::enable_force));
  queue.pop();
  CHECK(queue.waiting(Command::enable_force));
  queue.pop();
  CHECK_FALSE(queue.waiting(Command::enable_force));
}

TEST_CASE("after the loss of the host, the next command of the queue is a stop") {
  CommandQueue queue;
  CHECK(queue.push(make(Command::heartbeat, 5)));
  queue.pop();
  CHECK(queue.push(make(Command::enable_force, 6)));
  queue.host_gone();
  CHECK_FALSE(queue.take_sign_of_life());
  CHECK(queue.push(make(Command::clear_fault, 7)));  // a command of the next host, before the interrupt runs
  const CommandReport* command = queue.pop();
  REQUIRE(command != nullptr);
  CHECK(command->command == Command::stop);
  CHECK(queue.is_of_gone_host(*command));
  CHECK(command->token == 5);  // the discarded command is not acknowledged
  CHECK(queue.last_token() == 5);
  command = queue.pop();
  REQUIRE(command != nullptr);
  CHECK(command->token == 7);
  CHECK_FALSE(queue.is_of_gone_host(*command));
  CHECK(queue.pop() == nullptr);
  CHECK(queue.push(make(Command::stop, 8)));
  command = queue.pop();
  REQUIRE(command != nullptr);
  CHECK_FALSE(queue.is_of_gone_host(*command));
}

}  // namespace inkwell
