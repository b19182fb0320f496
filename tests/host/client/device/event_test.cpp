// Tests the device events from poses and parameter changes, and the length limit of the event log.
#include <doctest/doctest.h>

#include "host/client/device/event.hpp"
#include "host/client/device/hand_events.hpp"

using namespace inkwell;
using namespace inkwell::device;
using protocol::Fault;
using protocol::Parameter;
using protocol::State;

namespace {

device::Pose pose(std::uint32_t time_periods, State state, Fault fault = Fault::none) {
  device::Pose pose{};
  pose.time_periods = time_periods;
  pose.state = state;
  pose.fault = fault;
  return pose;
}

}  // namespace

TEST_CASE("the force and each fault produce one event when they begin and one event when they end") {
  CHECK(events_between({}, pose(10, State::ready), {}).empty());
  CHECK(events_between(pose(10, State::ready), pose(30, State::ready), {}).empty());

  const auto on = events_between(pose(10, State::ready), pose(30, State::active), {});
  REQUIRE(on.size() == 1);
  CHECK(on[0].kind == EventKind::force);
  CHECK(on[0].text == "The force is on.");
  CHECK(on[0].at_periods == 30);
  CHECK(on[0].clock_utc.size() == 27);

  // The event has the board's fault period, not the period of the pose that reported the fault.
  const auto fault = events_between(pose(30, State::active), pose(70, State::fault, Fault::supply_low), 61);
  REQUIRE(fault.size() == 2);
  CHECK(fault[0].text == "The force is off.");
  CHECK(fault[1].kind == EventKind::fault);
  CHECK(fault[1].text.starts_with("supply_low: "));
  CHECK(fault[1].at_periods == 61);
  CHECK(
      events_between(pose(70, State::fault, Fault::supply_low), pose(90, State::fault, Fault::supply_low), 61).empty());
  const auto over = events_between(pose(90, State::fault, Fault::supply_low), pose(110, State::ready), {});
  REQUIRE(over.size() == 1);
  CHECK(over[0].text == "supply_low was cleared.");
}

TEST_CASE("the event of a parameter change contains the previous value") {
  const auto before = protocol::default_parameters();
  auto now = before;
  now[Parameter::wall_stiffness_N_per_m] = 600.0f;
  now[Parameter::sphere_radius_m] = 0.004f;
  const auto events = events_of_change(before, now, 77, ", by another program");
  REQUIRE(events.size() == 2);
  CHECK(events[0].kind == EventKind::parameter);
  CHECK(events[0].at_periods == 77);
  CHECK(events_of_change(before, before, 77).empty());
  const bool is_reported = events[0].text == "wall_stiffness_N_per_m = 600.0, was 800.0, by another program" ||
                           events[1].text == "wall_stiffness_N_per_m = 600.0, was 800.0, by another program";
  CHECK(is_reported);
}

TEST_CASE("a log keeps its newest events under their numbers") {
  EventLog log;
  for (std::size_t i = 0; i < EventLog::kept_maximum + 3; ++i)
    log.add(event_now(EventKind::mark, std::to_string(i), {}));
  CHECK(log.begin() == 3);
  CHECK(log.end() == EventLog::kept_maximum + 3);
  CHECK(log[3].text == "3");
  CHECK(log[log.end() - 1].text == std::to_string(EventLog::kept_maximum + 2));
}

TEST_CASE("a line of the log has clock, time, kind and text; kinds come back by their names") {
  CHECK(line_of({EventKind::fault, "supply_low: it is low.", "2026-11-23T22:15:34.123Z", 20'001}) ==
        "2026-11-23T22:15:34.123Z          1.00005 s  fault       supply_low: it is low.\n");
  CHECK(line_of({EventKind::connection, "The device was disconnected.", "", {}}) ==
        "-                                         -  connection  The device was disconnected.\n");
  for (std::size_t i = 0; i < event_kind_count; ++i)
    CHECK(find_event_kind(name_of(static_cast<EventKind>(i))) == static_cast<EventKind>(i));
  CHECK_FALSE(find_event_kind("dance"));
}

TEST_CASE("pressed buttons and changed force sources are events at the time of their pose") {
  HandEvents hand;
  Pose pose{.state = State::active, .time_periods = 1000};
  CHECK(hand.take(pose).empty());
  pose.switches = 1;
  pose.force_sources = 1;
  pose.time_periods = 1020;
  auto events = hand.take(pose);
  REQUIRE(events.size() == 2);
  CHECK(events[0].kind == EventKind::button);
  CHECK(events[0].text == "Button 1 was pressed.");
  CHECK(events[0].at_periods == 1020);
  CHECK(events[1].kind == EventKind::source);
  CHECK(events[1].text == "Active force sources: walls.");
  pose.switches = 2;
  pose.time_periods = 1040;
  events = hand.take(pose);
  REQUIRE(events.size() == 2);
  CHECK(events[0].text == "Button 1 was released.");
  CHECK(events[1].text == "Button 2 was pressed.");

  // A bouncing probe changes the sources with each pose; their events are at least 50 ms apart.
  std::size_t sources = 0;
  for (; pose.time_periods < 21'020; pose.time_periods += 20) {
    pose.force_sources = static_cast<std::uint8_t>(5 - pose.force_sources);
    sources += hand.take(pose).size();
  }
  CHECK(sources > 10);
  CHECK(sources <= 20);
  pose.force_sources = 6;
  pose.time_periods += 2000;
  events = hand.take(pose);
  REQUIRE(events.size() == 1);
  CHECK(events[0].text == "Active force sources: shapes and program.");
}

TEST_CASE("the event of a shape contains all values of the shape") {
  Shapes shapes;
  shapes.planes[1] = Plane{{0.0f, 0.01f, -0.05f}, {0.0f, 0.0f, 1.0f}, {400.0f, 1.5f, 0.3f, 0.2f, 0.1f, 10.0f}};
  shapes.sphere = Sphere{{0.0f, 0.0f, 0.02f}, 0.015f, {}};
  const auto events = events_of_shapes(shapes, 50);
  REQUIRE(events.size() == 2);
  CHECK(events[0].kind == EventKind::shape);
  CHECK(events[0].at_periods == 50);
  CHECK(events[0].text ==
        "Plane 2: point (0, 0.01, -0.05) m, normal (0, 0, 1), 400 N/m, 1.5 Ns/m, friction 0.3 and 0.2, viscosity 0.1 "
        "Ns/m, life 10 s");
  CHECK(events[1].text ==
        "Sphere: center (0, 0, 0.02) m, radius 0.015 m, 800 N/m, 2 Ns/m, friction 0 and 0, viscosity 0 Ns/m, life "
        "inf s");
  CHECK(events_of_shapes({}, 50)[0].text == "All shapes were removed.");
}

TEST_CASE("an event has one line of printable text") {
  CHECK(event_now(EventKind::mark, "two\nlines\x1B[2J", {}).text == "two lines?[2J");
}
