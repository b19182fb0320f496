// An idle window draws rarely and reacts immediately to changes.
#include <doctest/doctest.h>

#include "host/companion/window/frame/frame_rhythm.hpp"

using namespace inkwell::window;

namespace {

/// Returns the number of frames that a loop with 60 checks per second draws in ten seconds.
int frames_drawn(const FrameEvidence& evidence, double drawing_s = 0.0) {
  FrameRhythm rhythm;
  rhythm.took(drawing_s);
  int drawn = 0;
  for (int i = 0; i < 600; ++i) {
    const double now_s = i / 60.0;
    if (rhythm.is_due(evidence.input || evidence.moves, now_s) && rhythm.record_evidence(evidence, now_s)) ++drawn;
  }
  return drawn;
}

}  // namespace

TEST_CASE("motion is drawn at the full rate, resting signals seldom, the same picture never") {
  CHECK(frames_drawn({.moves = true}) == 600);
  CHECK(frames_drawn({.differs = true}) >= 50);
  CHECK(frames_drawn({.differs = true}) <= 61);
  CHECK(frames_drawn({}) == 0);
  CHECK(frames_drawn({.input = true}) == 0);  // mouse input without a visible change
}

TEST_CASE("input wakes the window immediately, and the window stays awake for a short time") {
  FrameRhythm rhythm;
  rhythm.record_evidence({}, 10.0);
  CHECK_FALSE(rhythm.is_lively(10.01));
  CHECK_FALSE(rhythm.is_due(false, 10.01));
  CHECK(rhythm.is_due(true, 10.01));
  CHECK(rhythm.record_evidence({.input = true, .differs = true}, 10.01));
  CHECK(rhythm.is_due(false, 10.02));
  CHECK(rhythm.is_lively(10.01 + 0.9 * FrameRhythm::lively_for_s));
  CHECK_FALSE(rhythm.is_lively(10.01 + 1.1 * FrameRhythm::lively_for_s));
}

TEST_CASE("at rest, drawing uses only its share of the time, and motion is drawn in every frame") {
  CHECK(frames_drawn({.differs = true}, 0.005) >= 50);
  const double drawing_s = 0.025;
  const int drawn = frames_drawn({.differs = true}, drawing_s);
  CHECK(drawn * drawing_s <= 1.1 * FrameRhythm::resting_share * 10.0);
  CHECK(drawn >= 25);
  CHECK(frames_drawn({.differs = true}, 1.0) >= 19);
  CHECK(frames_drawn({.moves = true}, drawing_s) == 600);
}
