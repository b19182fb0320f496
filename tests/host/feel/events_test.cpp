#include <doctest/doctest.h>

#include <vector>

#include "host/feel/events.hpp"
#include "protocol/reports.hpp"

using namespace inkwell;
using feel::Event;

namespace {

struct EventRig {
  /// One millisecond in which the tip touches these objects.
  void touch(const std::vector<std::uint32_t>& objects, std::uint8_t switches = 0) {
    contact::Step step;
    for (const std::uint32_t object : objects) {
      step.contacts[step.contact_count].object = object;
      step.contacts[step.contact_count++].triangle = ++triangle;
    }
    watch.follow(step, switches, time_s += 0.001, queue);
  }
  std::vector<Event> take() {
    std::vector<Event> events;
    while (const auto event = queue.take()) events.push_back(*event);
    return events;
  }

  feel::EventWatch watch;
  feel::EventQueue queue;
  double time_s = 0;
  std::uint32_t triangle = 0;
};

constexpr auto button_1 = static_cast<std::uint8_t>(protocol::Switch::button_1);
constexpr auto button_2 = static_cast<std::uint8_t>(protocol::Switch::button_2);

}  // namespace

TEST_CASE("a touch is one event, although its contacts change, until the object was free for 5 ms") {
  EventRig rig;
  rig.touch({});
  rig.touch({7, 7});
  rig.touch({7, 3});
  for (int i = 0; i < 4; ++i) rig.touch({3});
  rig.touch({3, 7});  // object 7 was free for 4 ms only
  auto events = rig.take();
  REQUIRE(events.size() == 2);
  CHECK(events[0].kind == Event::Kind::touched);
  CHECK(events[0].contact.object == 7);
  CHECK(events[0].contact.triangle == 1);
  CHECK(events[0].time_s == doctest::Approx(0.002));
  CHECK(events[1].contact.object == 3);
  for (int i = 0; i < 7; ++i) rig.touch({3});
  events = rig.take();
  REQUIRE(events.size() == 1);
  CHECK(events[0].kind == Event::Kind::left);
  CHECK(events[0].contact.object == 7);
  CHECK(events[0].contact_time_s == doctest::Approx(0.008));
  CHECK(events[0].time_s == doctest::Approx(0.013));
  rig.watch.end_touches(1, rig.queue);
  rig.watch.end_touches(1, rig.queue);
  CHECK(rig.take().size() == 1);
}

TEST_CASE("buttons that change are events with the touched object; buttons pressed at the start are none") {
  EventRig rig;
  rig.touch({}, button_2);
  rig.touch({}, button_2 | button_1);
  rig.touch({5}, button_1);
  const auto events = rig.take();
  REQUIRE(events.size() == 3);
  CHECK(events[0].kind == Event::Kind::pressed);
  CHECK(events[0].button == 1);
  CHECK(events[0].contact.object == 0);
  CHECK(events[1].kind == Event::Kind::touched);
  CHECK(events[2].kind == Event::Kind::released);
  CHECK(events[2].button == 2);
  CHECK(events[2].contact.object == 5);
}

TEST_CASE("a full queue counts the lost events, and keeps the older events") {
  feel::EventQueue queue;
  for (int number = 0; number < static_cast<int>(feel::EventQueue::capacity) + 3; ++number)
    queue.put({.kind = Event::Kind::pressed, .button = number, .time_s = 0, .contact = {}, .contact_time_s = 0});
  CHECK(queue.lost() == 3);
  CHECK(queue.take()->button == 0);
  queue.put({});
  CHECK(queue.lost() == 3);
  int count = 0;
  while (queue.take()) ++count;
  CHECK(count == static_cast<int>(feel::EventQueue::capacity));
}
