#include <vector>

#include <doctest/doctest.h>

#include "host/companion/window/frame/key_order.hpp"

using namespace inkwell::window;

namespace {

constexpr auto press = QueuedInput::key_press, modifier = QueuedInput::modifier, other = QueuedInput::other;

std::size_t applied(const std::vector<QueuedInput>& queue) { return events_of_frame(queue); }

}  // namespace

TEST_CASE("a modifier that changes after a key press waits for the next frame, with all later events") {
  CHECK(applied({press, modifier}) == 1);
  CHECK(applied({modifier, other, press, other, modifier, press, modifier}) == 4);
}

TEST_CASE("a modifier before the key press changes in the same frame") {
  CHECK(applied({modifier, modifier, press}) == 3);
  CHECK(applied({other, modifier, other}) == 3);
}

TEST_CASE("events without a modifier are applied together") {
  CHECK(applied({press, other, press}) == 3);
  CHECK(applied({}) == 0);
}
