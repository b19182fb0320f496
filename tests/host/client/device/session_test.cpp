#include <doctest/doctest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstring>
#include <optional>
#include <thread>

#include "host/client/device/session.hpp"

#include "tests/host/client/device/fake_usbip_server.hpp"

using namespace inkwell;
using namespace inkwell::tests;
using device::Connection;
using protocol::Parameter;

namespace {

bool was_sent(FakeUsbipServer& server, protocol::Command command) {
  const auto commands = server.commands();
  return std::any_of(commands.begin(), commands.end(), [&](const auto& report) { return report.command == command; });
}

std::size_t count_of(FakeUsbipServer& server, protocol::Command command) {
  const auto commands = server.commands();
  return static_cast<std::size_t>(
      std::count_if(commands.begin(), commands.end(), [&](const auto& report) { return report.command == command; }));
}

protocol::PoseReport pose_at(std::uint32_t time_periods) {
  protocol::PoseReport pose{};
  pose.report_id = protocol::ReportId::pose;
  pose.time_periods = time_periods;
  return pose;
}

bool is_connected(const device::Session& session) { return session.status().connection == Connection::connected; }

}  // namespace

TEST_CASE("a session connects, shows pose and parameters, and gives its sign of life") {
  FakeUsbipServer server;
  device::Session session([&] { return std::optional(server.endpoint()); });
  REQUIRE(eventually([&] { return is_connected(session); }));
  CHECK(session.status().information->serial_number == "0123456789ABCDEF01234567");
  CHECK(session.parameters() == server.parameters);

  protocol::PoseReport pose{};
  pose.report_id = protocol::ReportId::pose;
  for (std::uint32_t sequence : {10u, 11u, 15u}) {
    pose.sequence = sequence;
    pose.time_periods = sequence * 200;
    const auto heartbeats = count_of(server, protocol::Command::heartbeat);
    server.send(1, bytes_of(pose));
    CHECK(eventually([&] { return count_of(server, protocol::Command::heartbeat) > heartbeats; }));
  }
  REQUIRE(eventually([&] { return session.status().poses_received == 3; }));
  CHECK(session.newest_pose()->sequence == 15);
  CHECK(session.status().poses_lost == 3);
}

TEST_CASE("the time of a board continues after a disconnection, even across the wrap of its counter") {
  constexpr std::int64_t wrap = std::int64_t{1} << 32;
  FakeUsbipServer server;
  server.bus_frame.time_periods = 0xFFFF'FFF0;
  device::Session session([&] { return std::optional(server.endpoint()); });
  const auto shows = [&](std::int64_t time_periods) {
    return eventually([&] {
      const auto pose = session.newest_pose();
      return pose && pose->time_periods == time_periods;
    });
  };
  REQUIRE(eventually([&] { return is_connected(session); }));
  server.send(1, bytes_of(pose_at(10)));
  REQUIRE(shows(wrap + 10));
  server.bus_frame.time_periods = 20;
  server.hang_up();
  REQUIRE(eventually([&] { return session.reconnection().has_value(); }));
  server.send(1, bytes_of(pose_at(30)));
  CHECK(shows(wrap + 30));
}

TEST_CASE("a reported fault has the control period of its detection if this period is known") {
  const auto reported_at = [](std::optional<std::uint32_t> box_periods, protocol::Fault box_fault, bool is_restart,
                              std::optional<std::uint32_t> pose_before) {
    FakeUsbipServer server;
    if (box_periods) {
      server.black_box = {.is_complete = 1, .fault = box_fault, .fault_periods = *box_periods};
      server.black_box->is_restart = is_restart ? 1 : 0;
    }
    device::Session session([&] { return std::optional(server.endpoint()); });
    if (pose_before) server.send(1, bytes_of(pose_at(*pose_before)));
    auto pose = pose_at(1000);
    pose.state = protocol::State::fault;
    pose.fault = protocol::Fault::supply_low;
    server.send(1, bytes_of(pose));
    REQUIRE(eventually([&] { return session.status().fault.has_value(); }));
    CHECK(session.status().fault->fault == protocol::Fault::supply_low);
    const auto at_periods = session.status().fault->at_periods;
    pose.state = protocol::State::ready;
    server.send(1, bytes_of(pose));
    CHECK(eventually([&] { return !session.status().fault; }));
    return at_periods;
  };
  using protocol::Fault;
  CHECK(reported_at(990, Fault::supply_low, false, 980) == 990);
  CHECK(reported_at(990, Fault::supply_low, false, {}) == 990);
  CHECK(reported_at(970, Fault::supply_low, false, 980) == 1000);   // an older fault
  CHECK(reported_at(1001, Fault::supply_low, false, 980) == 1000);  // from before a reset
  CHECK(reported_at(990, Fault::over_speed, false, 980) == 1000);
  CHECK(reported_at(990, Fault::supply_low, true, 980) == 1000);
  CHECK(reported_at({}, Fault::none, false, 980) == 1000);
  CHECK(reported_at(0xFFFF'FFFF, Fault::supply_low, false, {}) == -1);  // before the counter wrapped
}

TEST_CASE(
    "a session records events of its device, and the event of a parameter change has the control period of the "
    "change") {
  FakeUsbipServer server;
  std::vector<device::Event> events;
  const auto event_with = [&](std::string_view part) {
    return std::ranges::find_if(events, [&](const auto& event) { return event.text.find(part) != std::string::npos; });
  };
  {
    device::Session session([&] { return std::optional(server.endpoint()); });
    const auto becomes_reported = [&](std::string_view part) {
      return eventually([&] {
        std::ranges::move(session.take_events(), std::back_inserter(events));
        return event_with(part) != events.end();
      });
    };
    CHECK(becomes_reported("Connected to 0123456789ABCDEF01234567"));
    session.set_parameters({{Parameter::wall_stiffness_N_per_m, 600.0f}});
    CHECK(becomes_reported("wall_stiffness_N_per_m = 600.0, was 800.0"));
    CHECK(event_with("wall_stiffness")->at_periods == session.status().applied_at_periods);
    CHECK(event_with("wall_stiffness")->at_periods);
    auto pose = pose_at(500);
    pose.state = protocol::State::active;
    server.send(1, bytes_of(pose));
    CHECK(becomes_reported("The force is on."));
    CHECK(event_with("The force is on.")->at_periods == 500);
    server.judge = [](const protocol::ParametersReport&) { return protocol::Refusal::out_of_range; };
    session.set_parameters({{Parameter::wall_stiffness_N_per_m, 700.0f}});
    CHECK(eventually([&] { return session.refusal().has_value(); }));
    CHECK(becomes_reported(*session.refusal()));
    server.hang_up();
    CHECK(becomes_reported("The device was disconnected."));
  }
  CHECK(std::ranges::count_if(events, [](const auto& event) { return event.text == "The force is on."; }) == 1);
}

TEST_CASE("a burst of parameter changes is sent together, with the last value of each parameter") {
  FakeUsbipServer server;
  std::atomic<int> entries = 0;
  server.judge = [&](const protocol::ParametersReport& report) {
    entries += report.count;
    return protocol::Refusal::accepted;
  };
  std::atomic<bool> is_there = false;
  device::Session session([&] { return is_there ? std::optional(server.endpoint()) : std::nullopt; });
  // All changes are queued before a device is connected, so the session merges them into one transaction.
  session.set_parameters({{Parameter::force_limit_N, 1.0f}});
  session.set_parameters({{Parameter::force_limit_N, 2.0f}, {Parameter::sphere_radius_m, 0.004f}});
  is_there = true;
  REQUIRE(eventually([&] { return session.parameters_revision() >= 2; }));
  CHECK((*session.parameters())[Parameter::force_limit_N] == 2.0f);
  CHECK((*session.parameters())[Parameter::sphere_radius_m] == 0.004f);
  CHECK(server.transactions() == 1);
  CHECK(entries == 2);
  CHECK_FALSE(session.refusal());
}

TEST_CASE("a refusal is kept until another transaction is accepted") {
  FakeUsbipServer server;
  server.judge = [](const protocol::ParametersReport& report) {
    return report.entries[0].value > 3 ? protocol::Refusal::out_of_range : protocol::Refusal::accepted;
  };
  device::Session session([&] { return std::optional(server.endpoint()); });
  session.set_parameters({{Parameter::force_limit_N, 4.0f}});
  REQUIRE(eventually([&] { return session.refusal().has_value(); }));
  CHECK(session.refusal()->find("force_limit_N") != std::string::npos);
  CHECK(session.parameters() == protocol::default_parameters());
  session.set_parameters({{Parameter::force_limit_N, 1.0f}});
  CHECK(eventually([&] { return !session.refusal(); }));
}

TEST_CASE("a session reconnects automatically, selects its signals again, and repeats no command") {
  FakeUsbipServer server;
  device::Session session([&] { return std::optional(server.endpoint()); });
  session.select_signals({protocol::Signal::force_N});
  REQUIRE(eventually([&] { return was_sent(server, protocol::Command::select_signals); }));
  session.send(protocol::Command::enable_force);
  REQUIRE(eventually([&] { return was_sent(server, protocol::Command::enable_force); }));
  server.hang_up();
  REQUIRE(eventually([&] { return server.imports() == 2 && is_connected(session); }));
  CHECK(eventually([&] { return count_of(server, protocol::Command::select_signals) == 2; }));
  CHECK(count_of(server, protocol::Command::enable_force) == 1);
}

TEST_CASE("a session sends its last requests before it is destroyed") {
  FakeUsbipServer server;
  std::atomic<bool> judging = false;
  server.judge = [&](const protocol::ParametersReport&) {
    judging = true;
    std::this_thread::sleep_for(std::chrono::milliseconds(50));  // the session is destroyed during the call
    return protocol::Refusal::accepted;
  };
  {
    device::Session session([&] { return std::optional(server.endpoint()); });
    session.set_parameters({{Parameter::force_limit_N, 3.0f}});
    REQUIRE(eventually([&] { return judging.load(); }));
    session.send(protocol::Command::disable_force);
    session.set_parameters({{Parameter::force_limit_N, 1.5f}});
  }
  CHECK(was_sent(server, protocol::Command::disable_force));
  CHECK(server.parameters[Parameter::force_limit_N] == 1.5f);
}

TEST_CASE("a session that ends while it drives the arm lets the force fall, and touches no other") {
  struct Row {
    std::vector<protocol::Command> commands;
    std::size_t let_fall;
  };
  using enum protocol::Command;
  for (const Row& row : {Row{{enable_force}, 1}, Row{{enable_force, stop}, 1}, Row{{enable_force, disable_force}, 2},
                         Row{{stop, enable_force}, 1}, Row{{heartbeat}, 0}}) {
    CAPTURE(row.commands.size());
    FakeUsbipServer server;
    {
      device::Session session([&] { return std::optional(server.endpoint()); });
      REQUIRE(eventually([&] { return is_connected(session); }));
      for (const auto command : row.commands) session.send(command);
    }
    CHECK(count_of(server, disable_force) == row.let_fall);
    CHECK_FALSE(server.driver.is_held());
  }
}

TEST_CASE("while another program drives, a session reports this, can stop the force, and can take over") {
  FakeUsbipServer server;
  protocol::ClaimReport other{.operation = protocol::ClaimOperation::claim, .claim = 77, .process_id = 4711};
  std::strcpy(other.program, "a\x1b[31mprogram");
  REQUIRE_FALSE(server.driver.accept(std::as_bytes(std::span(&other, 1)), 0));
  device::Session session([&] { return std::optional(server.endpoint()); });
  REQUIRE(eventually([&] { return is_connected(session); }));
  session.send(protocol::Command::enable_force);
  const auto problem = [&] { return session.status().command_problem.value_or(""); };
  REQUIRE(eventually([&] { return problem().find("driven by a?[31mprogram (process 4711)") != std::string::npos; }));
  CHECK_FALSE(was_sent(server, protocol::Command::enable_force));
  session.send(protocol::Command::disable_force);
  CHECK(eventually([&] { return was_sent(server, protocol::Command::stop); }));
  session.take_over();
  session.send(protocol::Command::enable_force);
  CHECK(eventually([&] { return was_sent(server, protocol::Command::enable_force); }));
  CHECK(problem().empty());
}

TEST_CASE("a receiver of poses is called while the session drives the arm, and stops after an error") {
  FakeUsbipServer server;
  std::atomic<int> received = 0, first = 0, newest = 0;
  std::atomic<bool> fails = false;
  device::Session session([&] { return std::optional(server.endpoint()); });
  session.on_pose([&](device::Device& device, const device::DrivenPose& driven) {
    if (fails) throw device::Error("The receiver failed.");
    ++received;
    first += driven.is_first ? 1 : 0;
    newest += driven.is_newest ? 1 : 0;
    CHECK(device.drives());
    CHECK(driven.parameters == server.parameters);
  });
  REQUIRE(eventually([&] { return is_connected(session); }));
  std::uint32_t sequence = 0;
  const auto send_pose = [&] {
    auto pose = pose_at(++sequence * 20);
    pose.sequence = sequence;
    pose.state = protocol::State::active;
    pose.driver_parity = 1;  // of the session's claim
    const auto before = session.status().poses_received;
    server.send(1, bytes_of(pose));
    REQUIRE(eventually([&] { return session.status().poses_received > before; }));
  };
  send_pose();
  send_pose();
  CHECK(received == 0);
  session.send(protocol::Command::enable_force);
  REQUIRE(eventually([&] { return was_sent(server, protocol::Command::enable_force); }));
  for (int i = 0; i < 5; ++i) send_pose();
  // The status is updated before the call.
  CHECK(eventually([&] { return received >= 4; }));
  CHECK(first == 1);
  CHECK(newest > 0);
  fails = true;
  send_pose();
  CHECK(eventually([&] { return session.status().command_problem == "The receiver failed."; }));
  fails = false;
  const int before = received;
  send_pose();
  send_pose();
  CHECK(received == before);
  CHECK(is_connected(session));
}

TEST_CASE("pending changes of a broken connection still reach the device") {
  FakeUsbipServer server;
  server.parameters[Parameter::sphere_radius_m] = 0.004f;
  server.transactions_to_break_at = 2;
  device::Session session([&] { return std::optional(server.endpoint()); });
  SUBCASE("changes") { session.set_parameters({{Parameter::force_limit_N, 2.5f}}); }
  SUBCASE("the defaults, and changes after them") {
    session.restore_default_parameters();
    session.set_parameters({{Parameter::force_limit_N, 2.5f}});
  }
  REQUIRE(eventually([&] { return server.imports() == 3 && server.transactions() > 0; }));
  REQUIRE(eventually([&] { return (*session.parameters())[Parameter::force_limit_N] == 2.5f; }));
}

TEST_CASE("requests made during a failed transaction override its changes after the reconnection") {
  FakeUsbipServer server;
  server.transactions_to_break_at = 1;
  device::Session session([&] { return std::optional(server.endpoint()); });
  REQUIRE(eventually([&] { return is_connected(session); }));
  auto expected = protocol::default_parameters();
  SUBCASE("another value") {
    server.on_break = [&] { session.set_parameters({{Parameter::force_limit_N, 1.5f}}); };
    expected[Parameter::force_limit_N] = 1.5f;
    expected[Parameter::sphere_radius_m] = 0.004f;
  }
  SUBCASE("the defaults") {
    server.on_break = [&] { session.restore_default_parameters(); };
  }
  session.set_parameters({{Parameter::force_limit_N, 2.5f}, {Parameter::sphere_radius_m, 0.004f}});
  REQUIRE(eventually([&] { return server.transactions() > 0 && is_connected(session); }));
  CHECK(eventually([&] { return session.parameters() == expected; }));
  CHECK(server.transactions() == 1);
}

TEST_CASE("defaults that were restored are not restored again when the change after them did not get through") {
  FakeUsbipServer server;
  std::atomic<int> restorations = 0;
  server.judge = [&](const protocol::ParametersReport& report) {
    if (report.operation == protocol::ParameterOperation::restore_defaults) {
      ++restorations;
      server.transactions_to_break_at = 1;
    }
    return protocol::Refusal::accepted;
  };
  device::Session session([&] { return std::optional(server.endpoint()); });
  session.restore_default_parameters();
  session.set_parameters({{Parameter::force_limit_N, 2.5f}});
  REQUIRE(eventually([&] { return server.imports() == 2 && is_connected(session); }));
  CHECK(eventually([&] { return (*session.parameters())[Parameter::force_limit_N] == 2.5f; }));
  CHECK(restorations == 1);
  CHECK(server.transactions() == 2);
}

TEST_CASE("requests made during a transaction are carried out after it") {
  FakeUsbipServer server;
  std::optional<device::Session> session;
  server.judge = [&](const protocol::ParametersReport& report) {
    if (report.entries[0].id == info(Parameter::force_limit_N).id) {
      session->set_parameters({{Parameter::sphere_radius_m, 0.004f}});
      session->send(protocol::Command::clear_fault);
      session->select_signals({protocol::Signal::force_N});
    }
    return protocol::Refusal::accepted;
  };
  session.emplace([&] { return std::optional(server.endpoint()); });
  REQUIRE(eventually([&] { return is_connected(*session); }));
  session->set_parameters({{Parameter::force_limit_N, 2.5f}});
  CHECK(eventually([&] { return (*session->parameters())[Parameter::sphere_radius_m] == 0.004f; }));
  CHECK((*session->parameters())[Parameter::force_limit_N] == 2.5f);
  CHECK(count_of(server, protocol::Command::clear_fault) == 1);
  CHECK(count_of(server, protocol::Command::select_signals) == 1);
  CHECK(server.transactions() == 2);
}

TEST_CASE("a transaction that the device stalls is not sent again by the connection after it") {
  FakeUsbipServer server;
  server.stalls_accepted = true;
  std::atomic<int> limits = 0, radii = 0;
  server.judge = [&](const protocol::ParametersReport& report) {
    for (std::size_t i = 0; i < report.count; ++i)
      ++(report.entries[i].id == info(Parameter::force_limit_N).id ? limits : radii);
    return protocol::Refusal::accepted;
  };
  device::Session session([&] { return std::optional(server.endpoint()); });
  session.set_parameters({{Parameter::force_limit_N, 2.5f}});
  REQUIRE(eventually([&] { return server.imports() == 2 && is_connected(session); }));
  session.set_parameters({{Parameter::sphere_radius_m, 0.004f}});  // a repeated transaction would arrive by then
  REQUIRE(eventually([&] { return radii == 1; }));
  CHECK(limits == 1);
}

TEST_CASE("changes after a transaction that the device stalls reach the device through the next connection") {
  FakeUsbipServer server;
  std::atomic<int> restorations = 0, changes = 0;
  server.judge = [&](const protocol::ParametersReport& report) {
    server.stalls_accepted = report.operation == protocol::ParameterOperation::restore_defaults;
    ++(server.stalls_accepted ? restorations : changes);
    return protocol::Refusal::accepted;
  };
  std::atomic<bool> is_there = false;
  device::Session session([&] { return is_there ? std::optional(server.endpoint()) : std::nullopt; });
  session.restore_default_parameters();
  session.set_parameters({{Parameter::force_limit_N, 2.5f}});
  is_there = true;
  CHECK(eventually([&] { return changes == 1; }));
  REQUIRE(
      eventually([&] { return is_connected(session) && (*session.parameters())[Parameter::force_limit_N] == 2.5f; }));
  CHECK(restorations == 1);
  CHECK(changes == 1);
}

TEST_CASE("the defaults replace changes that were asked for before") {
  FakeUsbipServer server;
  std::atomic<bool> is_there = false;
  device::Session session([&] { return is_there ? std::optional(server.endpoint()) : std::nullopt; });
  session.set_parameters({{Parameter::force_limit_N, 2.5f}});
  session.restore_default_parameters();
  is_there = true;
  REQUIRE(eventually([&] { return server.transactions() > 0; }));
  session.set_parameters({{Parameter::sphere_radius_m, 0.004f}});
  REQUIRE(eventually([&] { return (*session.parameters())[Parameter::sphere_radius_m] == 0.004f; }));
  CHECK((*session.parameters())[Parameter::force_limit_N] == info(Parameter::force_limit_N).default_value);
  CHECK(server.transactions() == 2);
}

TEST_CASE("a command without an arm does not reach the next arm") {
  FakeUsbipServer server;
  std::atomic<bool> is_there = false;
  device::Session session([&] { return is_there ? std::optional(server.endpoint()) : std::nullopt; });
  session.send(protocol::Command::enable_force);
  is_there = true;
  REQUIRE(eventually([&] { return is_connected(session); }));
  session.send(protocol::Command::clear_fault);
  REQUIRE(eventually([&] { return was_sent(server, protocol::Command::clear_fault); }));
  CHECK_FALSE(was_sent(server, protocol::Command::enable_force));
}

TEST_CASE("a session reads parameters and counters every second of device time") {
  FakeUsbipServer server;
  std::atomic<int> readings = 0;
  std::atomic<float> radius_m = 0.0f;  // set by another program
  server.spoil[protocol::ReportId::information] = [&](Bytes& report) {
    report[offsetof(protocol::InformationReport, servo_overruns)] = static_cast<std::byte>(++readings);
  };
  server.spoil[protocol::ReportId::parameters] = [&](Bytes& report) {
    if (radius_m == 0.0f) return;
    protocol::ParametersReport changed;
    std::memcpy(&changed, report.data(), sizeof changed);
    changed.entries[static_cast<std::size_t>(Parameter::sphere_radius_m)].value = radius_m;
    report = bytes_of(changed);
  };
  device::Session session([&] { return std::optional(server.endpoint()); });
  REQUIRE(eventually([&] { return is_connected(session); }));
  const int before = readings;
  const auto revision = session.parameters_revision();
  std::uint64_t poses = 0;
  const auto pass = [&](std::uint32_t time_periods) {  // the second pose shows that the first was handled
    for (int i = 0; i < 2; ++i) {
      server.send(1, bytes_of(pose_at(time_periods)));
      REQUIRE(eventually([&, wanted = ++poses] { return session.status().poses_received == wanted; }));
    }
  };
  constexpr std::uint32_t begin = 1000, second = protocol::servo_rate_Hz;
  pass(begin);
  pass(begin + second - 1);
  CHECK(readings == before);
  pass(begin + second);
  pass(begin + second + 1);
  CHECK(readings == before + 1);
  CHECK(session.parameters_revision() == revision);
  radius_m = 0.004f;
  pass(begin + 2 * second);
  CHECK(readings == before + 2);
  CHECK(session.status().information->report.servo_overruns == static_cast<std::uint32_t>(before + 2));
  CHECK((*session.parameters())[Parameter::sphere_radius_m] == 0.004f);
  CHECK(session.parameters_revision() == revision + 1);
}

TEST_CASE("the status of a session contains the control period of the last applied transaction") {
  FakeUsbipServer server;
  device::Session session([&] { return std::optional(server.endpoint()); });
  REQUIRE(eventually([&] { return is_connected(session); }));
  CHECK_FALSE(session.status().applied_at_periods);
  for (const float limit_N : {1.0f, 2.0f}) {
    session.set_parameters({{Parameter::force_limit_N, limit_N}});
    REQUIRE(eventually([&] { return (*session.parameters())[Parameter::force_limit_N] == limit_N; }));
    CHECK(session.status().applied_at_periods == 100 * server.transactions());
  }
}

TEST_CASE("scope frames reach the callback of the session, and lost or malformed frames are counted") {
  FakeUsbipServer server;
  device::Session session([&] { return std::optional(server.endpoint()); });
  std::atomic<std::int64_t> newest_period = 0;
  session.on_scope([&](const device::ScopeSamples& samples) { newest_period = samples.first_period; });
  session.select_signals({protocol::Signal::force_N});
  REQUIRE(eventually([&] { return was_sent(server, protocol::Command::select_signals); }));
  for (const auto& command : server.commands()) {
    if (command.command != protocol::Command::select_signals) continue;
    server.send(2, scope_frame(command.token, 10, 0.5f));
    server.send(2, Bytes(64));
    server.send(2, scope_frame(command.token, 14, 0.5f));
  }
  CHECK(eventually([&] { return newest_period == 14; }));
  CHECK(session.status().scope_samples_received == 2);
  CHECK(session.status().scope_samples_lost == 3);
  CHECK(eventually([&] { return session.status().scope_frames_malformed == 1; }));
}

TEST_CASE("a silent arm is reported while it is silent, and its pose rate is zero") {
  FakeUsbipServer server;
  device::Session session([&] { return std::optional(server.endpoint()); });
  REQUIRE(eventually([&] { return is_connected(session); }));
  for (std::uint32_t i = 0; session.status().pose_rate_Hz == 0.0; ++i) {
    REQUIRE(i < 60'000);
    server.send(1, bytes_of(pose_at(i)));
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  CHECK(eventually([&] { return session.status().message.find("silent") != std::string::npos; }));
  CHECK(session.status().pose_rate_Hz == 0.0);
  CHECK(is_connected(session));
  std::uint32_t sequence = 60'000;
  CHECK(eventually([&] {
    server.send(1, bytes_of(pose_at(sequence++)));
    return session.status().message.find("silent") == std::string::npos;
  }));
}

TEST_CASE("nothing is left of an arm that went away, but its parameters") {
  FakeUsbipServer server;
  std::atomic<bool> is_there = true;
  auto endpoint = server.endpoint();
  endpoint.is_virtual = true;
  device::Session session([&] { return is_there ? std::optional(endpoint) : std::nullopt; });
  session.set_parameters({{Parameter::force_limit_N, 2.5f}});
  REQUIRE(eventually([&] { return session.status().applied_at_periods.has_value(); }));
  CHECK(session.status().is_simulation);
  for (std::uint32_t i = 0; session.status().pose_rate_Hz == 0.0; ++i) {
    REQUIRE(i < 60'000);
    server.send(1, bytes_of(pose_at(i)));
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  is_there = false;
  server.hang_up();
  REQUIRE(eventually([&] { return !session.status().information; }));
  const auto status = session.status();
  CHECK(status.connection == Connection::searching);
  CHECK(status.pose_rate_Hz == 0.0);
  CHECK_FALSE(status.applied_at_periods);
  CHECK_FALSE(session.newest_pose());
  CHECK((*session.parameters())[Parameter::force_limit_N] == 2.5f);
}

TEST_CASE("while there is no device it is looked for five times a second, not without a break") {
  using Clock = std::chrono::steady_clock;
  const auto begin = Clock::now();
  std::atomic<int> searches = 0;
  device::Session session([&]() -> std::optional<device::Endpoint> {
    ++searches;
    return std::nullopt;
  });
  REQUIRE(eventually([&] { return searches >= 4; }));
  const int count = searches;
  CHECK(count <= 1 + (Clock::now() - begin) / std::chrono::milliseconds(200));
}

TEST_CASE("a session states the reason why it is not connected") {
  SUBCASE("nothing there") {
    device::Session session([]() -> std::optional<device::Endpoint> { return std::nullopt; });
    CHECK(eventually([&] { return !session.status().message.empty(); }));
    CHECK(session.status().connection == Connection::searching);
    CHECK_FALSE(session.newest_pose());
  }
  SUBCASE("another version") {
    FakeUsbipServer server;
    server.information.version = 99;
    device::Session session([&] { return std::optional(server.endpoint()); });
    CHECK(eventually([&] { return session.status().connection == Connection::incompatible; }));
    CHECK(session.status().message.find("99") != std::string::npos);
  }
  SUBCASE("no permission") {
    device::Session session(
        []() -> std::optional<device::Endpoint> { throw device::NoPermission("Write the udev line."); });
    CHECK(eventually([&] { return session.status().connection == Connection::no_permission; }));
  }
}
