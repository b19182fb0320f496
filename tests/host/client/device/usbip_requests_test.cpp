// Tests requests of a program to a device over USB/IP: parameter transactions, forces, shapes, and every possible
// refusal.
#include <doctest/doctest.h>

#include <atomic>
#include <chrono>
#include <cstring>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "firmware/control/signal_path/installed_force_law.hpp"

#include "host/client/device/device.hpp"
#include "tests/failure.hpp"

#include "tests/host/client/device/fake_usbip_server.hpp"

using namespace inkwell;
using namespace inkwell::tests;
using namespace std::chrono_literals;
using protocol::Parameter;

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

TEST_CASE("a refusal names the parameter, the reason and the range") {
  FakeUsbipServer server;
  server.judge = [](const auto&) { return protocol::Refusal::out_of_range; };
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
  CHECK_NOTHROW(arm->set_parameters(changes));
  CHECK(server.transactions() == 3);
}

TEST_CASE("a transaction that meets a busy device for seconds is refused") {
  FakeUsbipServer server;
  server.judge = [](const auto&) { return protocol::Refusal::busy; };
  const auto arm = device::Device::open(server.endpoint());
  const std::vector<device::ParameterChange> changes{{Parameter::force_limit_N, 2.0f}};
  CHECK(contains(message_of<device::Refused>([&] { arm->set_parameters(changes); }), "force_limit_N = 2"));
}

TEST_CASE("a stall of an accepted transaction is an error, and the transaction is not repeated") {
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
  CHECK(contains(message, "do not match this companion") == is_refused);
}

TEST_CASE("a feature report that is too short is refused with both lengths") {
  FakeUsbipServer server;
  const auto cut = [](Bytes& report) { report.pop_back(); };
  std::string message;
  SUBCASE("information") {
    server.spoil[protocol::ReportId::information] = cut;
    message = message_of<device::Incompatible>([&] { device::Device::open(server.endpoint()); });
    CHECK(contains(message, "information report has 107 bytes instead of 108"));
  }
  SUBCASE("transaction") {
    server.spoil[protocol::ReportId::transaction] = cut;
    const auto arm = device::Device::open(server.endpoint());
    message = message_of<device::Incompatible>([&] { arm->restore_default_parameters(); });
    CHECK(contains(message, "transaction report has 19 bytes instead of 20"));
  }
  SUBCASE("frame") {
    server.spoil[protocol::ReportId::frame] = cut;
    message = message_of<device::Incompatible>([&] { device::Device::open(server.endpoint()); });
    CHECK(contains(message, "frame report has 15 bytes instead of 16"));
  }
  CHECK(contains(message, "Flash"));
}

TEST_CASE("forces reach the device unchanged and numbered from 0, next to commands") {
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
  std::atomic<int> busy = 2;  // busy until the interrupt has applied the previous shapes
  server.judge_shapes = [&] {
    return busy > 0 ? (--busy, protocol::RequestResult::busy) : protocol::RequestResult::accepted;
  };
  const auto arm = device::Device::open(server.endpoint());
  arm->claim();
  device::Shapes shapes;
  shapes.planes[1] = device::Plane{.point_m = {0.01f, 0.02f, 0.03f}};
  shapes.sphere = device::Sphere{.centre_m = {0, 0, -0.05f}};
  arm->place_shapes(shapes);
  arm->place_shapes({});
  auto report = device::shapes_report(shapes);
  const auto placed = server.shapes_placed();
  REQUIRE(placed.size() == 2);
  std::memcpy(&report.claim, &placed[0][offsetof(protocol::ShapesReport, claim)], sizeof report.claim);
  std::memcpy(&report.ticket, &placed[0][offsetof(protocol::ShapesReport, ticket)], sizeof report.ticket);
  CHECK(report.ticket != 0);
  CHECK(server.driver.is_held_by(report.claim));
  auto expected = bytes_of(report);
  expected.resize(protocol::shapes_report_size(2));
  CHECK(placed[0] == expected);
  CHECK(placed[1].size() == protocol::shapes_report_size(0));
  CHECK(busy == 0);
}

TEST_CASE("shapes that the device refuses, or has no room for within seconds, are given up with the reason") {
  FakeUsbipServer server;
  std::string part;
  SUBCASE("busy") {
    server.judge_shapes = [&] {
      server.request_results.report.time_periods += protocol::servo_rate_Hz / 10;
      return protocol::RequestResult::busy;
    };
    part = "The board refused shapes. The board dropped the request";
  }
  SUBCASE("malformed") {
    server.judge_shapes = [] { return protocol::RequestResult::malformed; };
    part = "The board refused shapes. The request has a wrong version or length";
  }
  const auto arm = device::Device::open(server.endpoint());
  arm->claim();
  CHECK(contains(message_of<device::Error>([&] { arm->place_shapes({}); }), part));
  CHECK(server.shapes_placed().empty());
  CHECK(arm->drives());
}

TEST_CASE("shapes of a program that does not drive end its claim") {
  FakeUsbipServer server;
  server.judge_shapes = [] { return protocol::RequestResult::not_the_driver; };
  const auto arm = device::Device::open(server.endpoint());
  arm->claim();
  CHECK_THROWS_AS(arm->place_shapes({}), device::InUse);
  CHECK_FALSE(arm->drives());
}

TEST_CASE("shapes are placed again where the results of other programs have replaced theirs") {
  FakeUsbipServer server;
  int asked = 0;
  server.spoil[protocol::ReportId::request_results] = [&](Bytes& report) {
    if (++asked == 1) report = bytes_of(protocol::RequestResultsReport{});
  };
  const auto arm = device::Device::open(server.endpoint());
  arm->claim();
  arm->place_shapes({});
  CHECK(server.shapes_placed().size() == 2);
}

TEST_CASE("a command that finds the board busy is sent again, and given up after seconds of board time") {
  FakeUsbipServer server;
  const auto arm = device::Device::open(server.endpoint());
  int busy = 3;
  server.spoil[protocol::ReportId::request_results] = [&](Bytes& bytes) {
    protocol::RequestResultsReport report;
    std::memcpy(&report, bytes.data(), sizeof report);
    for (auto& entry : report.entries)
      if (entry.ticket != 0 && busy > 0) entry.result = protocol::RequestResult::busy;
    report.time_periods = server.request_results.report.time_periods += protocol::servo_rate_Hz / 10;
    --busy;
    bytes = bytes_of(report);
  };
  arm->carry_out(protocol::Command::disable_force);
  CHECK(server.commands().size() == 4);
  busy = std::numeric_limits<int>::max();
  CHECK(contains(message_of<device::Error>([&] { arm->carry_out(protocol::Command::disable_force); }),
                 "The board refused a command. The board dropped the request"));
}

TEST_CASE("a device object requests only as many bytes of each report as it uses") {
  FakeUsbipServer server;
  std::map<protocol::ReportId, std::vector<std::size_t>> asked;
  server.on_get = [&](protocol::ReportId id, std::size_t length) { asked[id].push_back(length); };
  const auto arm = device::Device::open(server.endpoint());
  arm->parameters();
  const std::size_t law_size = control::installed_force_law.report_size;
  CHECK(asked[protocol::ReportId::force_law] == std::vector<std::size_t>{sizeof(protocol::ForceLawReport), law_size});
  CHECK(asked[protocol::ReportId::parameters] ==
        std::vector<std::size_t>{protocol::parameters_report_size(protocol::parameter_count)});
}

TEST_CASE("a device without bus frame counts can be opened, and bus_frame returns no value") {
  FakeUsbipServer server;
  server.bus_frame = {};
  const auto arm = device::Device::open(server.endpoint());
  CHECK_FALSE(arm->bus_frame().has_value());
}
