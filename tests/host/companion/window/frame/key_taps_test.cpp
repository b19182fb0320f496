#include <array>

#include <doctest/doctest.h>

#include "host/companion/window/frame/key_taps.hpp"

using inkwell::window::KeyTaps;

TEST_CASE("a key that is tapped between two frames is down for one of them") {
  KeyTaps taps;
  std::array<bool, 8> down{};
  taps.note(3);  // released again: down[3] stays false
  taps.apply(down);
  CHECK(down[3]);
  taps.apply(down);
  CHECK_FALSE(down[3]);
}

TEST_CASE("KeyTaps leaves a held key pressed") {
  KeyTaps taps;
  std::array<bool, 8> down{};
  taps.note(5);
  down[5] = true;
  taps.apply(down);
  taps.apply(down);
  CHECK(down[5]);
  taps.note(99);  // unknown keys are ignored
  taps.apply(down);
}
