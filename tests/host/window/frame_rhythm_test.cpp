// A window at rest draws seldom, and wakes at once.
#include <cmath>
#include <random>

#include <doctest/doctest.h>

#include <window/frame_rhythm.hpp>

using namespace inkwell;
using namespace inkwell::window;

namespace {

/// Frames drawn in ten seconds of a loop that looks 60 times a second and always sees the same.
int frames_drawn(const FrameEvidence& evidence) {
  FrameRhythm rhythm;
  int drawn = 0;
  for (int i = 0; i < 600; ++i) {
    const double now_s = i / 60.0;
    if (rhythm.is_due(evidence.input || evidence.moves, now_s) && rhythm.is_to_be_drawn(evidence, now_s)) ++drawn;
  }
  return drawn;
}

}  // namespace

TEST_CASE("motion is drawn at the full rate, resting signals seldom, the same picture never") {
  CHECK(frames_drawn({.moves = true}) == 600);
  CHECK(frames_drawn({.differs = true}) >= 50);
  CHECK(frames_drawn({.differs = true}) <= 61);
  CHECK(frames_drawn({}) == 0);
  CHECK(frames_drawn({.input = true}) == 0);  // a mouse that changes nothing
}

TEST_CASE("input wakes the window at once, and it stays awake for a moment") {
  FrameRhythm rhythm;
  rhythm.is_to_be_drawn({}, 10.0);
  CHECK_FALSE(rhythm.is_lively(10.01));
  CHECK_FALSE(rhythm.is_due(false, 10.01));
  CHECK(rhythm.is_due(true, 10.01));
  CHECK(rhythm.is_to_be_drawn({.input = true, .differs = true}, 10.01));
  CHECK(rhythm.is_due(false, 10.02));
  CHECK(rhythm.is_lively(10.01 + 0.9 * FrameRhythm::lively_for_s));
  CHECK_FALSE(rhythm.is_lively(10.01 + 1.1 * FrameRhythm::lively_for_s));
}

TEST_CASE("a pose looks different when a person could see it") {
  protocol::PoseReport a{};
  protocol::PoseReport b = a;
  b.sequence = 77;
  b.servo_load = 9;
  b.position_m[1] = 1e-4f;
  CHECK_FALSE(looks_different(a, b));
  SUBCASE("position") { b.position_m[1] = 1e-3f; }
  SUBCASE("force") { b.force_N[2] = 0.1f; }
  SUBCASE("stylus") { b.gimbal_rad[0] = 0.1f; }
  SUBCASE("state") { b.state = protocol::State::fault; }
  CHECK(looks_different(a, b));
  CHECK(looks_different(a, std::nullopt));
}

TEST_CASE("noise is no motion, a step and a constant that moves by pixels are") {
  std::mt19937 random{7};
  std::normal_distribution<float> noise{0.0f, 0.01f};
  SignalSeries series(1u << 16);
  for (int i = 0; i < 40'000; ++i) series.append(noise(random));
  int motions = 0;
  for (int frame = 0; frame < 100; ++frame) {
    const auto seen = series.end();
    for (int i = 0; i < 3'333; ++i) series.append(noise(random));
    if (leaves_range(series.extremes(seen, series.end()), series.extremes(seen - 40'000, seen), 0.001)) ++motions;
  }
  CHECK(motions <= 1);  // a third of a million samples may hold one that stands out
  CHECK(leaves_range({-0.01f, 0.08f}, {-0.04f, 0.04f}, 0.001));
  CHECK(leaves_range({0.5f, 0.5f}, {0.4f, 0.4f}, 0.05));
  CHECK_FALSE(leaves_range({0.42f, 0.42f}, {0.4f, 0.4f}, 0.05));
  const float lost = std::nanf("");
  CHECK_FALSE(leaves_range({lost, lost}, {0.0f, 1.0f}, 0.1));
  CHECK_FALSE(leaves_range({0.0f, 1.0f}, {lost, lost}, 0.1));
}
