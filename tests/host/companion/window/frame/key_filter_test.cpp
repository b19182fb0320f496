#include <doctest/doctest.h>

#include "host/companion/window/frame/key_filter.hpp"

using namespace inkwell::window;

namespace {

constexpr int press = 1, repeat = 2, letter_a = 65, enter = 257;

bool passes(int key, int action, bool can_cancel) { return is_for_imgui({key, 0, action, 0}, can_cancel); }

}  // namespace

TEST_CASE("the space bar never reaches ImGui, which would press the focused control with it") {
  for (const int action : {press, key_release, repeat})
    for (const bool can_cancel : {false, true}) CHECK_FALSE(passes(space_bar, action, can_cancel));
}

TEST_CASE("Escape reaches ImGui only if it cancels something, and its release always") {
  CHECK_FALSE(passes(escape_key, press, false));
  CHECK_FALSE(passes(escape_key, repeat, false));
  CHECK(passes(escape_key, press, true));
  CHECK(passes(escape_key, key_release, false));
}

TEST_CASE("Ctrl+Tab goes to the next part and does not reach ImGui; its release and Tab alone do") {
  for (const int modifiers : {control_modifier, control_modifier | shift_modifier})
    for (const int action : {press, repeat}) {
      CHECK(is_next_part({tab_key, 0, action, modifiers}));
      CHECK_FALSE(is_for_imgui({tab_key, 0, action, modifiers}, false));
    }
  CHECK(is_for_imgui({tab_key, 0, key_release, control_modifier}, false));
  CHECK(is_for_imgui({tab_key, 0, press, shift_modifier}, false));
  CHECK_FALSE(is_next_part({tab_key, 0, press, shift_modifier}));
  CHECK_FALSE(is_next_part({letter_a, 0, press, control_modifier}));
}

TEST_CASE("other keys reach ImGui at any time") {
  for (const int key : {letter_a, enter})
    for (const int action : {press, key_release, repeat}) CHECK(passes(key, action, false));
}
