// Tests the displayed range of the scope: the newest samples, the past while paused, or the time around an event.
#include <cmath>

#include <doctest/doctest.h>

#include "host/companion/window/scope/timeline.hpp"
#include "protocol/reports.hpp"

using namespace inkwell;
using namespace inkwell::window;

namespace {

constexpr double rate_Hz = protocol::servo_rate_Hz;
constexpr protocol::Signal force = protocol::Signal::force_N;

/// Appends `count` force samples; the force is 1 N from sample `rise` on.
void receive(Timeline& timeline, std::size_t count, std::size_t rise = 1'000'000) {
  const auto first = static_cast<std::uint32_t>(timeline.history().end());
  device::ScopeSamples samples{{force}, first, count, {}, 0};
  for (std::size_t i = 0; i < count; ++i) samples.values.push_back(first + i < rise ? 0.0f : 1.0f);
  timeline.receive(samples);
}

Timeline with_samples(std::size_t count, double span_s = 0.1) {
  Timeline timeline(span_s, {});
  receive(timeline, count);
  return timeline;
}

}  // namespace

TEST_CASE("the newest samples are shown, over the whole span") {
  Timeline timeline = with_samples(10'000);
  const Stretch shown = timeline.stretch();
  CHECK(shown.last == 10'000);
  CHECK(shown.span() == doctest::Approx(0.1 * rate_Hz));
  CHECK(shown.zero == shown.last);
}

TEST_CASE("a long picture rolls by whole parts of its span, so that it does not shimmer") {
  Timeline timeline = with_samples(50'001, 2.0);
  const double part = std::floor(2.0 * rate_Hz / 2048.0);
  const double last = timeline.stretch().last;
  CHECK(std::fmod(last, part) == 0.0);
  CHECK(last <= 50'001);
  CHECK(last > 50'001 - part);
}

TEST_CASE("other signals of the same time do not move a paused picture") {
  Timeline timeline = with_samples(10'000);
  timeline.pause(true);
  timeline.drag(0.5);
  receive(timeline, 500);
  const Stretch before = timeline.stretch();
  device::ScopeSamples other{{force, protocol::Signal::supply_V}, 4000, 6500, {}, 7};
  for (std::size_t i = 0; i < other.count; ++i)
    for (const float value : {1.0f, static_cast<float>(i)}) other.values.push_back(value);
  timeline.refill({{other, std::nullopt}});
  CHECK(timeline.stretch().first == before.first);
  CHECK(timeline.stretch().last == before.last);
  CHECK(timeline.history().begin() == 4000);
  CHECK(timeline.history().end() == 10'500);
  CHECK((*timeline.history().find(protocol::Signal::supply_V))[9000] == 5000.0f);
  receive(timeline, 5);
  CHECK(timeline.history().end() == 10'505);
}

TEST_CASE("a pause retains the picture, and the samples of the pause are visible after the pause") {
  Timeline timeline = with_samples(10'000);
  timeline.pause(true);
  receive(timeline, 500);
  CHECK(timeline.stretch().last == 10'000);
  CHECK(timeline.stretch().zero == 10'000);
  timeline.pause(false);
  CHECK(timeline.history().end() == 10'500);
  CHECK(timeline.stretch().last == 10'500);
}

TEST_CASE("a long pause discards new samples before they overwrite the picture, and leaves a gap") {
  Timeline timeline = with_samples(10'000);
  timeline.pause(true);
  const double first = timeline.stretch().first;
  constexpr std::size_t part = 100'000;
  for (int i = 0; i < 30; ++i) {
    device::ScopeSamples samples{{force}, 10'000 + i * static_cast<std::int64_t>(part), part, {}, 0};
    samples.values.assign(part, 0.5f);
    timeline.receive(samples);
  }
  CHECK(static_cast<double>(timeline.history().begin()) <= first);
  const auto stored = timeline.history().end();
  timeline.pause(false);
  device::ScopeSamples samples{{force}, 10'000 + 30 * static_cast<std::int64_t>(part), part, {}, 0};
  samples.values.assign(part, 0.5f);
  timeline.receive(samples);
  REQUIRE(timeline.history().end() == 10'000 + 31 * part);
  CHECK(std::isnan((*timeline.history().find(force))[stored]));
}

TEST_CASE("a fault freezes the picture shortly after the fault, and the time axis begins at the fault") {
  Timeline timeline = with_samples(10'000);
  constexpr std::int64_t fault_period = 9'900;
  timeline.freeze_at(fault_period);
  CHECK_FALSE((timeline.stretch(), timeline.is_paused()));
  receive(timeline, 10'000);
  const Stretch frozen = timeline.stretch();
  CHECK(timeline.is_frozen_at_fault());
  CHECK(frozen.zero == fault_period);
  CHECK(frozen.last == doctest::Approx(fault_period + 0.25 * 0.1 * rate_Hz));
  timeline.pause(false);
  CHECK_FALSE(timeline.is_frozen_at_fault());
  CHECK(timeline.stretch().last == 20'000);
  timeline.show_fault();
  CHECK(timeline.stretch().zero == fault_period);
  timeline.restart();
  timeline.show_fault();
  CHECK_FALSE(timeline.is_paused());
}

TEST_CASE("a drag pauses the timeline and moves it into the past, as far as samples exist") {
  Timeline timeline = with_samples(10'000);
  timeline.drag(0.5);
  CHECK(timeline.is_paused());
  CHECK(timeline.stretch().last == doctest::Approx(10'000 - 0.5 * 0.1 * rate_Hz));
  timeline.drag(1000.0);
  CHECK(timeline.stretch().last == 0.0);
  timeline.drag(-1000.0);
  CHECK(timeline.stretch().last == doctest::Approx(10'000 + 0.5 * 0.1 * rate_Hz));
}

TEST_CASE("while paused, a zoom leaves the time under the mouse pointer unchanged") {
  Timeline timeline = with_samples(10'000);
  timeline.pause(true);
  const Stretch before = timeline.stretch();
  constexpr double right_part = 0.25;
  timeline.zoom(3.0, right_part);
  const Stretch after = timeline.stretch();
  CHECK(after.span() < before.span());
  CHECK(after.last - right_part * after.span() == doctest::Approx(before.last - right_part * before.span()));
}

TEST_CASE("the wheel leaves the span within its limits") {
  Timeline timeline = with_samples(10);
  timeline.zoom(1000.0, 0.0);
  CHECK(timeline.span_s() == ScopeSettings::span_minimum_s);
  timeline.zoom(-1000.0, 0.0);
  CHECK(timeline.span_s() == ScopeSettings::span_maximum_s);
}

TEST_CASE("with a trigger the picture lies around the event, and its axis begins there") {
  const TriggerSettings trigger{TriggerMode::normal, force, TriggerEdge::rising, 0.5f, 0.25f};
  Timeline timeline(0.1, trigger);
  receive(timeline, 10'000, 4'000);
  const Stretch shown = timeline.stretch();
  CHECK(shown.zero == 4'000);
  CHECK(shown.first == doctest::Approx(4'000 - 0.25 * 0.1 * rate_Hz));
  CHECK(shown.span() == doctest::Approx(0.1 * rate_Hz));

  SUBCASE("where it lies in the picture may change without losing it") {
    TriggerSettings moved = trigger;
    moved.pre_trigger = 0.5f;
    timeline.set_trigger(moved);
    CHECK(timeline.stretch().first == doctest::Approx(4'000 - 0.5 * 0.1 * rate_Hz));
  }
  SUBCASE("another level is another event") {
    TriggerSettings higher = trigger;
    higher.level = 2.0f;
    timeline.set_trigger(higher);
    CHECK(timeline.stretch().zero != 4'000);
  }
}
