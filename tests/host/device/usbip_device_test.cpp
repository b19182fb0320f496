// The device library against a USB/IP server: identity, poses, commands, parameters, scope, and every way in
// which the other end can fail.
#include <doctest/doctest.h>

#include <chrono>
#include <cstring>
#include <limits>
#include <thread>

#include <device/device.hpp>
#include <failure.hpp>

#include "fake_usbip_server.hpp"

using namespace inkwell;
using namespace inkwell::tests;
using namespace std::chrono_literals;
using protocol::Parameter;

namespace {

protocol::PoseReport pose_number(std::uint32_t sequence) {
  protocol::PoseReport pose{};
  pose.report_id = protocol::ReportId::pose;
  pose.state = protocol::State::ready;
  pose.sequence = sequence;
  pose.time_periods = 20 * sequence;
  pose.position_m[2] = 0.125f;
  return pose;
}

}  // namespace

TEST_CASE("a USB/IP server is asked for arms, and other devices are passed over") {
  FakeUsbipServer server;
  const auto found = device::find_usbip_devices("127.0.0.1", server.port());
  REQUIRE(found.size() == 1);
  CHECK(found[0].path == "1-1");
  server.product_id = 0x0BAD;
  CHECK(device::find_usbip_devices("127.0.0.1", server.port()).empty());
}

TEST_CASE("an arm on USB/IP tells who it is and streams its pose") {
  FakeUsbipServer server;
  server.information.firmware_version[1] = 3;
  const auto arm = device::Device::open(server.endpoint());
  const auto information = arm->information();
  CHECK(information.firmware_version == "0.3.0");
  CHECK(information.serial_number == "0123456789ABCDEF01234567");
  CHECK_FALSE(arm->read_pose(1ms));
  server.send(1, Bytes(5, std::byte{1}));  // not a pose: passed over
  for (std::uint32_t i = 0; i < 100; ++i) server.send(1, bytes_of(pose_number(i)));
  for (std::uint32_t i = 0; i < 100; ++i) {
    const auto pose = arm->read_pose(60s);
    REQUIRE(pose);
    CHECK(pose->sequence == i);
    CHECK(pose->position_m[2] == 0.125f);
  }
}

TEST_CASE("enough transfers are under way that a late reader loses nothing; the scope's, once it is selected") {
  FakeUsbipServer server;
  const auto arm = device::Device::open(server.endpoint());
  CHECK(eventually([&] { return server.waiting_transfers(1) >= 16; }));
  CHECK(server.waiting_transfers(2) == 0);
  arm->select_signals(std::vector{protocol::Signal::force_N});
  CHECK(eventually([&] { return server.waiting_transfers(2) >= 20; }));  // 20 frames of 6 KiB are 100 ms
}

TEST_CASE("commands carry version and a token that is never 0") {
  FakeUsbipServer server;
  const auto arm = device::Device::open(server.endpoint());
  for (int i = 0; i < 300; ++i) CHECK(arm->send(protocol::Command::heartbeat) != 0);
  arm->send(protocol::Command::test_current, {2, 0.5f, 0.04f});
  REQUIRE(eventually([&] { return server.commands().size() == 301; }));
  const auto commands = server.commands();
  CHECK(commands[0].version == protocol::protocol_version);
  CHECK(commands[0].token != commands[1].token);
  CHECK(commands[300].command == protocol::Command::test_current);
  CHECK(commands[300].test.motor == 2);
  CHECK(float{commands[300].test.amplitude} == 0.5f);  // a copy: in the report it may lie anywhere
}

TEST_CASE("keep_alive follows board time where that is faster than the clock") {
  FakeUsbipServer server;
  const auto arm = device::Device::open(server.endpoint());
  arm->send(protocol::Command::heartbeat);
  auto pose = pose_number(1);
  pose.time_periods = 10'000;
  server.send(1, bytes_of(pose));
  REQUIRE(arm->read_pose(60s));
  arm->keep_alive();
  CHECK(eventually([&] { return server.commands().size() >= 2; }));
}

TEST_CASE("a sign of life goes out 10 ms after the last command, or 200 control periods, and no sooner") {
  using Clock = std::chrono::steady_clock;
  FakeUsbipServer server;
  const auto arm = device::Device::open(server.endpoint());
  const auto commands_sent = [&] {  // commands arrive in order, so the count is complete when this one is there
    const auto token = arm->send(protocol::Command::clear_fault);
    REQUIRE(eventually([&] { return !server.commands().empty() && server.commands().back().token == token; }));
    return server.commands().size();
  };
  const auto hear_pose = [&](std::uint32_t time_periods) {
    auto pose = pose_number(1);
    pose.time_periods = time_periods;
    server.send(1, bytes_of(pose));
    REQUIRE(arm->read_pose(60s));
  };
  SUBCASE("by the clock") {
    const std::size_t before = commands_sent();
    hear_pose(1);
    std::this_thread::sleep_for(10ms);
    arm->keep_alive();
    CHECK(commands_sent() == before + 2);
  }
  SUBCASE("not to a device whose time stands still") {
    hear_pose(1);
    const std::size_t before = commands_sent();
    std::this_thread::sleep_for(10ms);
    hear_pose(1);
    arm->keep_alive();
    CHECK(commands_sent() == before + 1);
  }
  SUBCASE("no sooner") {
    for (std::uint32_t time_periods = 0;;) {  // until this computer is quick enough for it
      const auto begin = Clock::now();
      const std::size_t before = commands_sent();
      hear_pose(++time_periods);
      std::this_thread::sleep_for(4ms);
      arm->keep_alive();
      if (Clock::now() - begin >= 10ms) continue;
      CHECK(commands_sent() == before + 1);
      break;
    }
  }
  SUBCASE("by board time") {
    std::uint32_t time_periods = 0;
    const auto heartbeats_after = [&](std::uint32_t periods) {
      for (;;) {  // until the clock has no part in it
        const std::size_t before = commands_sent();
        const auto begin = Clock::now();
        arm->send(protocol::Command::heartbeat);
        hear_pose(time_periods += periods);
        arm->keep_alive();
        if (Clock::now() - begin < 10ms) return commands_sent() - before - 2;
      }
    };
    heartbeats_after(0);
    CHECK(heartbeats_after(199) == 0);
    CHECK(heartbeats_after(200) == 1);
  }
}

TEST_CASE("parameters are read, set as one transaction, and restored") {
  FakeUsbipServer server;
  server.parameters[Parameter::force_limit_N] = 1.25f;
  const auto arm = device::Device::open(server.endpoint());
  CHECK(arm->parameters() == server.parameters);
  const std::vector<device::ParameterChange> changes{{Parameter::box_minimum_x_m, -0.01f},
                                                     {Parameter::box_maximum_x_m, 0.02f}};
  CHECK(arm->set_parameters(changes).transactions == 1);
  CHECK(server.transactions() == 1);
  CHECK(arm->parameters()[Parameter::box_maximum_x_m] == 0.02f);
  arm->restore_default_parameters();
  CHECK(arm->parameters() == protocol::default_parameters());
}

TEST_CASE("a refusal names the parameter, the reason and the range, whether the device stalls or not") {
  FakeUsbipServer server;
  server.judge = [](const auto&) { return protocol::Refusal::out_of_range; };
  SUBCASE("with a stall") { server.stalls_refusals = true; }
  SUBCASE("without") {}
  const auto arm = device::Device::open(server.endpoint());
  const std::vector<device::ParameterChange> changes{{Parameter::force_limit_N, 9.0f}};
  const auto message = message_of<device::Refused>([&] { arm->set_parameters(changes); });
  CHECK(contains(message, "force_limit_N = 9"));
  CHECK(contains(message, "0 to 8 N"));
}

TEST_CASE("a transaction that meets a busy device is tried again") {
  FakeUsbipServer server;
  int attempts = 0;
  server.judge = [&](const auto&) { return ++attempts < 3 ? protocol::Refusal::busy : protocol::Refusal::accepted; };
  const auto arm = device::Device::open(server.endpoint());
  const std::vector<device::ParameterChange> changes{{Parameter::force_limit_N, 2.0f}};
  CHECK(arm->set_parameters(changes).refusal == protocol::Refusal::accepted);
  CHECK(server.transactions() == 3);
}

TEST_CASE("a stall of what the device says it accepted is an error, and the transaction is not repeated") {
  FakeUsbipServer server;
  server.stalls_accepted = true;
  const auto arm = device::Device::open(server.endpoint());
  const std::vector<device::ParameterChange> changes{{Parameter::force_limit_N, 2.0f}};
  CHECK(contains(message_of<device::Stalled>([&] { arm->set_parameters(changes); }), "refused a USB request"));
  CHECK(server.transactions() == 1);
}

TEST_CASE("more changes than a report holds are refused before they are sent") {
  FakeUsbipServer server;
  const auto arm = device::Device::open(server.endpoint());
  std::vector<device::ParameterChange> changes(protocol::parameter_entries_maximum, {Parameter::force_limit_N, 2.0f});
  arm->set_parameters(changes);
  changes.push_back(changes[0]);
  CHECK(contains(message_of<device::Error>([&] { arm->set_parameters(changes); }), "too many"));
  CHECK(server.transactions() == 1);
}

TEST_CASE("parameters that are not whole, of another version or of another number are refused") {
  FakeUsbipServer server;
  auto& spoil = server.spoil[protocol::ReportId::parameters];
  const auto change = [](auto member, auto by) {
    return [=](Bytes& report) {
      protocol::ParametersReport changed;
      std::memcpy(&changed, report.data(), sizeof changed);
      changed.*member = static_cast<std::uint16_t>(changed.*member + by);
      report = bytes_of(changed);
    };
  };
  constexpr auto whole = protocol::parameters_report_size(protocol::parameter_count);
  bool is_refused = true;
  SUBCASE("cut short") {
    spoil = [](Bytes& report) { report.resize(whole - 1); };
  }
  SUBCASE("one less") { spoil = change(&protocol::ParametersReport::count, -1); }
  SUBCASE("one more") { spoil = change(&protocol::ParametersReport::count, 1); }
  SUBCASE("version") { spoil = change(&protocol::ParametersReport::version, 1); }
  SUBCASE("as long as its entries") {
    spoil = [](Bytes& report) { report.resize(whole); };
    is_refused = false;
  }
  const auto arm = device::Device::open(server.endpoint());
  const auto message = message_of<device::Incompatible>([&] { arm->parameters(); });
  CHECK(contains(message, "do not fit this companion") == is_refused);
}

TEST_CASE("a feature report that is too short is refused with both lengths") {
  FakeUsbipServer server;
  const auto cut = [](Bytes& report) { report.pop_back(); };
  std::string message;
  SUBCASE("information") {
    server.spoil[protocol::ReportId::information] = cut;
    message = message_of<device::Incompatible>([&] { device::Device::open(server.endpoint()); });
    CHECK(contains(message, "information report has 71 bytes instead of 72"));
  }
  SUBCASE("transaction") {
    server.spoil[protocol::ReportId::transaction] = cut;
    const auto arm = device::Device::open(server.endpoint());
    message = message_of<device::Incompatible>([&] { arm->restore_default_parameters(); });
    CHECK(contains(message, "transaction report has 15 bytes instead of 16"));
  }
  SUBCASE("frame") {
    server.spoil[protocol::ReportId::frame] = cut;
    const auto arm = device::Device::open(server.endpoint());
    message = message_of<device::Incompatible>([&] { arm->frame(); });
    CHECK(contains(message, "frame report has 15 bytes instead of 16"));
  }
  CHECK(contains(message, "Flash"));
}

TEST_CASE("the begin of the newest frame of the bus is told as the device counts it") {
  FakeUsbipServer server;
  server.frame.sequence = 12;
  server.frame.time_cycles = 345;
  const auto arm = device::Device::open(server.endpoint());
  CHECK(arm->frame().sequence == 12);
  CHECK(arm->frame().time_cycles == 345);
}

TEST_CASE("forces reach the device as they were asked, numbered from 0, beside the commands") {
  FakeUsbipServer server;
  const auto arm = device::Device::open(server.endpoint());
  const device::ForceRequest request{
      .force_N = {1.0f, -2.0f, 3.0f}, .mode = protocol::ForceMode::instead_of_walls, .interval_ms = 4};
  for (int i = 0; i < 3; ++i) arm->send_force(request);
  arm->send(protocol::Command::heartbeat);
  REQUIRE(eventually([&] { return server.commands().size() == 1; }));
  const auto forces = server.forces();
  REQUIRE(forces.size() == 3);
  for (std::uint32_t i = 0; i < 3; ++i) {
    auto expected = device::force_report(request);
    expected.sequence = i;
    CHECK(bytes_of(forces[i]) == bytes_of(expected));
  }
  CHECK_THROWS_AS(arm->send_force({.interval_ms = 0}), device::Error);
}

TEST_CASE("shapes reach the device as one report, as long as its planes are many") {
  FakeUsbipServer server;
  server.shapes_stalls = 2;  // as long as the interrupt has not taken those before
  const auto arm = device::Device::open(server.endpoint());
  device::Shapes shapes;
  shapes.planes[1] = device::Plane{.point_m = {0.01f, 0.02f, 0.03f}};
  shapes.sphere = device::Sphere{.centre_m = {0, 0, -0.05f}};
  arm->place_shapes(shapes);
  arm->place_shapes({});
  auto expected = bytes_of(device::shapes_report(shapes));
  expected.resize(protocol::shapes_report_size(2));
  const auto placed = server.shapes_placed();
  REQUIRE(placed.size() == 2);
  CHECK(placed[0] == expected);
  CHECK(placed[1].size() == protocol::shapes_report_size(0));
  CHECK(server.shapes_stalls == 0);
}

TEST_CASE("shapes that the device goes on to stall are given up with a sentence") {
  FakeUsbipServer server;
  server.shapes_stalls = std::numeric_limits<int>::max();
  const auto arm = device::Device::open(server.endpoint());
  CHECK(contains(message_of<device::Stalled>([&] { arm->place_shapes({}); }), "refused a USB request"));
  CHECK(server.shapes_placed().empty());
  CHECK_NOTHROW(arm->information());
}

TEST_CASE("firmware of another protocol version is refused with the remedy") {
  FakeUsbipServer server;
  SUBCASE("version") {
    server.information.version = protocol::protocol_version + 1;
    const auto message = message_of<device::Incompatible>([&] { device::Device::open(server.endpoint()); });
    const std::string asked = "version " + std::to_string(protocol::protocol_version);
    CHECK(contains(message, asked.c_str()));
    CHECK(contains(message, "Flash"));
  }
  SUBCASE("tables") {
    server.information.parameter_table_hash ^= 1u;
    CHECK(contains(message_of<device::Incompatible>([&] { device::Device::open(server.endpoint()); }), "parameters"));
  }
}

TEST_CASE("scope frames arrive decoded; empty transfers between them are nothing") {
  FakeUsbipServer server;
  const auto arm = device::Device::open(server.endpoint());
  const std::vector<protocol::Signal> signals{protocol::Signal::force_N};
  const auto token = arm->select_signals(signals);
  protocol::ScopeFrameHeader header{};
  header.first_period = 77;
  header.sample_count = 1;
  header.signal_count = 1;
  header.selection_token = token;
  header.length = sizeof header + 4;
  Bytes frame = bytes_of(header);
  const Bytes value = bytes_of(2.5f);
  frame.insert(frame.end(), value.begin(), value.end());
  server.send(2, {});
  server.send(2, Bytes(64, std::byte{0xAA}));
  server.send(2, frame);
  const auto samples = arm->read_scope(60s);
  REQUIRE(samples);
  CHECK(samples->first_period == 77);
  CHECK(samples->values == std::vector<float>{2.5f});
  CHECK(arm->malformed_scope_frames() == 1);
  CHECK_FALSE(arm->read_scope(1ms));
}

TEST_CASE("a reader who stops reading the scope says so by taking a transfer back, and is served when he goes on") {
  FakeUsbipServer server;
  const auto transport = device::open_transport(server.endpoint());
  transport->claim_scope();
  constexpr std::size_t kept = 682, under_way = 21;
  REQUIRE(eventually([&] { return server.waiting_transfers(2) == under_way; }));
  for (std::size_t i = 0; i + 1 < kept; ++i) server.send(2, Bytes(4));
  REQUIRE(eventually([&] { return server.waiting_transfers(2) == under_way; }));
  CHECK(server.transfers_taken_back() == 0);
  server.send(2, Bytes(4));
  REQUIRE(eventually([&] { return server.waiting_transfers(2) == under_way - 2; }));
  CHECK(server.transfers_taken_back() == 1);
  for (std::size_t i = 0; i < under_way - 2; ++i) server.send(2, Bytes(4));  // those still count
  Bytes transfer(64);
  for (std::size_t i = 0; i < kept + under_way - 2; ++i) REQUIRE(transport->read_bulk(transfer, 60s) == 4);
  CHECK(eventually([&] { return server.waiting_transfers(2) == under_way; }));
  CHECK(server.transfers_taken_back() == 1);
}

TEST_CASE("a connection that breaks is told as Disconnected, in every call") {
  FakeUsbipServer server;
  const auto arm = device::Device::open(server.endpoint());
  server.send(1, bytes_of(pose_number(1)));
  REQUIRE(arm->read_pose(60s));
  server.hang_up();
  CHECK_THROWS_AS(arm->read_pose(60s), device::Disconnected);
  CHECK_THROWS_AS(arm->read_scope(60s), device::Disconnected);
  CHECK_THROWS_AS(arm->information(), device::Disconnected);
  CHECK_THROWS_AS(arm->send(protocol::Command::heartbeat), device::Disconnected);
}

TEST_CASE("a device that is in use, or is none of ours, is refused") {
  FakeUsbipServer server;
  SUBCASE("in use") {
    server.refuses_import = true;
    CHECK(contains(message_of<device::Error>([&] { device::Device::open(server.endpoint()); }), "another program"));
  }
  SUBCASE("without a scope") {
    server.configuration.resize(41);
    CHECK(contains(message_of<device::Error>([&] { device::Device::open(server.endpoint()); }), "scope"));
  }
  SUBCASE("damaged descriptor") {
    server.configuration[9] = std::byte{0};
    CHECK(contains(message_of<device::Error>([&] { device::Device::open(server.endpoint()); }), "damaged"));
  }
  SUBCASE("nobody there") {
    CHECK(contains(message_of<device::Error>([] { device::find_usbip_devices("127.0.0.1", 1); }), "Nothing answers"));
  }
}

TEST_CASE("a server that answers nothing is given up; a device that says nothing is not") {
  FakeUsbipServer silent, quiet;
  silent.silent = true;
  const auto arm = device::Device::open(quiet.endpoint());
  const auto address = std::to_string(silent.port());
  const auto message = message_of<device::Error>([&] { device::find_usbip_devices("127.0.0.1", silent.port()); });
  CHECK(contains(message, "gives no answer"));
  CHECK(contains(message, address.c_str()));
  CHECK_NOTHROW(arm->information());
}
