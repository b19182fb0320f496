// Tests that the trigger finds each crossing once and waits for a complete picture.
#include <doctest/doctest.h>

#include "host/companion/window/scope/trigger.hpp"

using namespace inkwell::window;

namespace {

constexpr double span = 100.0;

// A square wave: alternately 50 samples low and 50 samples high.
void append_square(SignalSeries& series, int count) {
  for (int i = 0; i < count; ++i) series.append(series.end() / 50 % 2 == 1 ? 1.0f : 0.0f);
}

}  // namespace

TEST_CASE("crossings are found at the sample that reaches the level") {
  SignalSeries series(1024);
  append_square(series, 200);
  CHECK(find_crossing(series, 0, 200, 0.5f, TriggerEdge::rising) == 50);
  CHECK(find_crossing(series, 0, 200, 0.5f, TriggerEdge::falling) == 100);
  CHECK(find_crossing(series, 51, 200, 0.5f, TriggerEdge::rising) == 150);
  CHECK_FALSE(find_crossing(series, 0, 50, 0.5f, TriggerEdge::rising));
  CHECK_FALSE(find_crossing(series, 0, 200, 1.5f, TriggerEdge::rising));
}

TEST_CASE("an event counts once its picture is complete") {
  SignalSeries series(1024);
  TriggerSettings settings{TriggerMode::normal, {}, TriggerEdge::rising, 0.5f, 0.2f};
  Trigger trigger;
  append_square(series, 120);  // rises at 50; 80 samples after the crossing belong to the picture
  trigger.advance(series, settings, span);
  CHECK_FALSE(trigger.event());
  append_square(series, 20);
  trigger.advance(series, settings, span);
  CHECK(trigger.event() == 50);
  append_square(series, 120);  // rises at 150 and at 250; the picture of the latter is incomplete
  trigger.advance(series, settings, span);
  CHECK(trigger.event() == 150);
}

TEST_CASE("a single event stays until the trigger is armed, and then only later ones count") {
  SignalSeries series(2048);
  TriggerSettings settings{TriggerMode::single, {}, TriggerEdge::rising, 0.5f, 0.5f};
  Trigger trigger;
  append_square(series, 400);
  trigger.advance(series, settings, span);
  CHECK(trigger.event() == 50);
  append_square(series, 400);
  trigger.advance(series, settings, span);
  CHECK(trigger.event() == 50);
  trigger.arm();
  trigger.advance(series, settings, span);
  CHECK_FALSE(trigger.event());
  append_square(series, 200);
  trigger.advance(series, settings, span);
  CHECK(trigger.event() == 850);
}
