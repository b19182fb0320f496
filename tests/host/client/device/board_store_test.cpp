// Tests storing and erasing parameters on the board, and the reactions of the session.
#include <doctest/doctest.h>

#include <atomic>
#include <cstddef>
#include <cstring>
#include <string>

#include "host/client/device/board_store.hpp"
#include "host/client/device/session.hpp"
#include "tests/failure.hpp"

#include "tests/host/client/device/fake_usbip_server.hpp"

using namespace inkwell;
using namespace inkwell::tests;
using protocol::Command;
using protocol::Parameter;
using protocol::StoreResult;

namespace {

/// The server's board time advances by this number of periods at each read.
void let_time_pass(FakeUsbipServer& server, std::uint32_t periods_each_time) {
  server.spoil[protocol::ReportId::frame] = [time = 0u, periods_each_time](Bytes& report) mutable {
    time += periods_each_time;
    std::memcpy(report.data() + offsetof(protocol::FrameReport, time_periods), &time, sizeof time);
  };
}

bool is_connected(const device::Session& session) {
  return session.status().connection == device::Connection::connected;
}

std::size_t not_stored_by(const device::Session& session) {
  return device::not_stored(*session.parameters(), *session.status().store).size();
}

}  // namespace

TEST_CASE("parameters can be stored, compared with the stored values, restored and erased") {
  FakeUsbipServer server;
  const auto arm = device::Device::open(server.endpoint());
  CHECK(not_stored(arm->parameters(), read_store(*arm)).empty());
  arm->set_parameters(
      std::vector<device::ParameterChange>{{Parameter::link_2_m, 0.2f}, {Parameter::force_limit_N, 2.5f}});
  CHECK(not_stored(arm->parameters(), read_store(*arm)) == std::vector{Parameter::force_limit_N, Parameter::link_2_m});
  CHECK(store_parameters(*arm).records_written == 1);
  CHECK(not_stored(arm->parameters(), read_store(*arm)).empty());
  arm->set_parameters(std::vector<device::ParameterChange>{{Parameter::force_limit_N, 1.0f}});
  CHECK(arm->stored_parameters()[Parameter::force_limit_N] == 2.5f);
  arm->restore_stored_parameters();
  CHECK(arm->parameters()[Parameter::force_limit_N] == 2.5f);
  CHECK(factory_reset(*arm).commands == 2);
  CHECK(arm->parameters() == protocol::default_parameters());
  CHECK(arm->stored_parameters() == protocol::default_parameters());
}

TEST_CASE("a refused store command raises an error with its meaning and remedy") {
  FakeUsbipServer server;
  const auto arm = device::Device::open(server.endpoint());
  for (const auto result : {StoreResult::force_is_on, StoreResult::no_room, StoreResult::flash_failed}) {
    server.judge_store = [result](Command) { return result; };
    const auto sentence = message_of<device::NotStored>([&] { store_parameters(*arm); });
    CHECK(contains(sentence, "The parameters were not stored."));
    CHECK(contains(sentence, std::string(info(result).meaning)));
    CHECK(contains(sentence, std::string(info(result).remedy)));
    CHECK(contains(message_of<device::NotStored>([&] { factory_reset(*arm); }),
                   "The stored parameters were not erased."));
  }
  server.judge_store = [](Command) { return StoreResult::nothing_stored; };
  CHECK_NOTHROW(factory_reset(*arm));
}

TEST_CASE("an older command's result is not taken for this one's") {
  FakeUsbipServer server;
  const auto arm = device::Device::open(server.endpoint());
  SUBCASE("done") { store_parameters(*arm); }
  SUBCASE("refused") {
    server.judge_store = [](Command) { return StoreResult::force_is_on; };
    CHECK_THROWS_AS(store_parameters(*arm), device::NotStored);
  }
  server.holds_outputs = true;  // the output report is answered later
  server.ignores_store = true;
  std::atomic<int> asked = 0;
  server.spoil[protocol::ReportId::store] = [&](Bytes& report) {
    constexpr int asked_before_it_comes = 5;
    if (++asked <= asked_before_it_comes) return;
    auto report_of_store = server.store;
    report_of_store.commands += 1;
    report_of_store.result = asked <= 2 * asked_before_it_comes ? StoreResult::under_way : StoreResult::done;
    report = bytes_of(report_of_store);
  };
  CHECK(store_parameters(*arm).result == StoreResult::done);
  CHECK(asked > 10);
}

TEST_CASE("a board that does not execute or finish a store command causes an error after one second of board time") {
  FakeUsbipServer server;
  const auto arm = device::Device::open(server.endpoint());
  constexpr std::uint32_t step = protocol::servo_rate_Hz / 10;
  let_time_pass(server, step);
  std::atomic<int> asked = 0;
  server.spoil[protocol::ReportId::store] = [&](Bytes&) { ++asked; };
  SUBCASE("takes none") {
    server.ignores_store = true;
    CHECK(contains(message_of<device::Error>([&] { store_parameters(*arm); }), "did not execute the command"));
  }
  SUBCASE("never ends it") {
    server.judge_store = [](Command) { return StoreResult::under_way; };
    const auto sentence = message_of<device::NotStored>([&] { store_parameters(*arm); });
    CHECK(contains(sentence, std::string(info(StoreResult::under_way).meaning)));
  }
  CHECK(asked == 1 + protocol::servo_rate_Hz / step + 1);
}

TEST_CASE("a session stores the newest parameters and can erase the stored parameters") {
  FakeUsbipServer server;
  device::Session session([&] { return std::optional(server.endpoint()); });
  REQUIRE(eventually([&] { return is_connected(session); }));
  CHECK(not_stored_by(session) == 0);
  session.set_parameters({{Parameter::force_limit_N, 2.5f}});
  session.store_parameters();
  CHECK(session.status().is_storing);
  REQUIRE(eventually([&] { return !session.status().is_storing; }));
  CHECK(session.status().store->report.records_written == 1);
  CHECK(session.status().store->at_next_start[Parameter::force_limit_N] == 2.5f);
  CHECK_FALSE(session.status().store_problem);
  session.factory_reset();
  REQUIRE(eventually([&] { return !session.status().is_storing; }));
  CHECK(session.parameters() == protocol::default_parameters());
  CHECK(session.status().store->at_next_start == protocol::default_parameters());
}

TEST_CASE("a session reports a store problem until the next store request") {
  FakeUsbipServer server;
  std::atomic<bool> is_refused = true;
  server.judge_store = [&](Command) { return is_refused ? StoreResult::force_is_on : StoreResult::done; };
  device::Session session([&] { return std::optional(server.endpoint()); });
  REQUIRE(eventually([&] { return is_connected(session); }));
  session.store_parameters();
  REQUIRE(eventually([&] { return session.status().store_problem.has_value(); }));
  CHECK(contains(*session.status().store_problem, std::string(info(StoreResult::force_is_on).remedy)));
  CHECK(is_connected(session));
  is_refused = false;
  session.store_parameters();
  CHECK_FALSE(session.status().store_problem);
  REQUIRE(eventually([&] { return session.status().store->report.records_written == 1; }));
}

TEST_CASE("a session notices after one second of device time that another program changed the stored parameters") {
  FakeUsbipServer server;
  device::Session session([&] { return std::optional(server.endpoint()); });
  REQUIRE(eventually([&] { return is_connected(session); }));
  auto stored = server.at_next_start;
  stored[Parameter::force_limit_N] = 1.0f;
  auto report = server.store;
  SUBCASE("another set") {
    report.records_written = 1;
    report.stores_left = 41;
  }
  SUBCASE("no set, and yet the state has changed") {
    stored = server.at_next_start;
    report.stores_left = 42;
  }
  const auto records = report.records_written;
  server.spoil[protocol::ReportId::store] = [report](Bytes& report_of_store) { report_of_store = bytes_of(report); };
  server.spoil[protocol::ReportId::stored] = [stored](Bytes& report_of_store) {
    protocol::ParametersReport parameters;
    std::memcpy(&parameters, report_of_store.data(), sizeof parameters);
    parameters.entries[static_cast<std::size_t>(Parameter::force_limit_N)].value = stored[Parameter::force_limit_N];
    report_of_store = bytes_of(parameters);
  };
  protocol::PoseReport pose{};
  pose.report_id = protocol::ReportId::pose;
  for (const std::uint32_t time_periods : {0u, protocol::servo_rate_Hz}) {
    pose.time_periods = time_periods;
    server.send(1, bytes_of(pose));
  }
  REQUIRE(eventually([&] { return session.status().store->report.stores_left == report.stores_left; }));
  CHECK(session.status().store->report.records_written == records);
  CHECK(session.status().store->at_next_start == stored);
}

TEST_CASE("a store request without a device does not reach the next device") {
  FakeUsbipServer server;
  std::atomic<bool> is_there = false;
  device::Session session([&] { return is_there ? std::optional(server.endpoint()) : std::nullopt; });
  session.store_parameters();
  CHECK_FALSE(session.status().is_storing);
  is_there = true;
  REQUIRE(eventually([&] { return is_connected(session); }));
  session.send(Command::clear_fault);
  const auto was_sent = [&](Command command) {
    return std::ranges::any_of(server.commands(), [&](const auto& each) { return each.command == command; });
  };
  REQUIRE(eventually([&] { return was_sent(Command::clear_fault); }));
  CHECK_FALSE(was_sent(Command::store_parameters));
}

TEST_CASE("a pending store request is discarded when the connection breaks") {
  FakeUsbipServer server;
  device::Session session([&] { return std::optional(server.endpoint()); });
  REQUIRE(eventually([&] { return is_connected(session); }));
  server.on_break = [&] { session.store_parameters(); };
  server.transactions_to_break_at = 1;
  session.set_parameters({{Parameter::force_limit_N, 2.5f}});
  REQUIRE(eventually([&] { return server.imports() == 2 && server.transactions() == 1; }));
  CHECK_FALSE(session.status().is_storing);
  session.send(Command::clear_fault);
  const auto was_sent = [&](Command command) {
    return std::ranges::any_of(server.commands(), [&](const auto& each) { return each.command == command; });
  };
  REQUIRE(eventually([&] { return was_sent(Command::clear_fault); }));
  CHECK_FALSE(was_sent(Command::store_parameters));
}

TEST_CASE("after a reconnection, a session reports the previous and the current values of the device") {
  FakeUsbipServer server;
  std::atomic<bool> is_there = true;
  device::Session session([&] { return is_there ? std::optional(server.endpoint()) : std::nullopt; });
  session.set_parameters({{Parameter::force_limit_N, 2.5f}, {Parameter::sphere_radius_m, 0.004f}});
  REQUIRE(eventually([&] { return session.status().applied_at_periods.has_value(); }));
  CHECK_FALSE(session.reconnection());
  const auto lose = [&] {
    is_there = false;
    server.hang_up();
    REQUIRE(eventually([&] { return !session.status().information; }));
  };
  lose();
  CHECK_FALSE(session.status().store);
  server.parameters[Parameter::force_limit_N] = 3.3f;
  SUBCASE("the same one") {
    session.set_parameters({{Parameter::sphere_radius_m, 0.003f}});  // the change still reaches the board
    is_there = true;
    REQUIRE(eventually([&] { return session.reconnection().has_value(); }));
    const auto first = *session.reconnection();
    CHECK(first.before[Parameter::force_limit_N] == 2.5f);
    CHECK(first.before[Parameter::sphere_radius_m] == 0.003f);
    CHECK(first.after[Parameter::force_limit_N] == 3.3f);
    CHECK(first.after[Parameter::sphere_radius_m] == 0.004f);
    lose();
    CHECK_FALSE(session.reconnection());
    is_there = true;
    REQUIRE(eventually([&] { return session.reconnection().has_value(); }));
    CHECK(session.reconnection()->number == first.number + 1);
    CHECK(session.reconnection()->before[Parameter::force_limit_N] == 3.3f);
  }
  SUBCASE("another one") {
    server.serial_number = "76543210FEDCBA9876543210";
    is_there = true;
    REQUIRE(eventually([&] { return is_connected(session); }));
    CHECK_FALSE(session.reconnection());
  }
}
