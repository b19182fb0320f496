// The window offers its firmware to a board with another version, writes the firmware, and continues with the board.
#include <doctest/doctest.h>

#include "tests/system/window_rig.hpp"

using namespace inkwell;
using namespace inkwell::tests;

TEST_CASE("a board that speaks another version of the protocol is updated from the window, by its own image") {
  std::string board, image;
  SUBCASE("the board of the companion's image") { board = "omni_driver", image = "next-protocol.elf"; }
  SUBCASE("another one") { board = "bench_modules", image = "next-protocol-bench_modules.elf"; }
  WindowRig window = WindowRig::with_image(image, board);
  auto sight = window.wait_until("the firmware is offered",
                                 [](const Sight& now) { return now.can_click("connection/Update firmware"); });
  CHECK(sight.says("Protocol mismatch"));
  CHECK(sight.says("for " + board));
  CHECK(sight.says("keeps the stored parameters"));
  window.click("connection/Update firmware");
  sight = window.wait_until("it asks, because the board's firmware is newer",
                            [](const Sight& now) { return now.can_click("connection/Write older firmware"); });
  CHECK(sight.says("The board has a newer firmware"));
  CHECK(sight.says("Defects that were corrected since then would return"));
  window.click("connection/Write older firmware");
  sight = window.wait_until("it is under way", [](const Sight& now) { return now.says("erasing"); });
  CHECK(sight.says("Updating the firmware"));
  CHECK(sight.says("Do not unplug the board"));
  CHECK_FALSE(sight.has("connection/Update firmware"));
  window.wait_until("it is done", [](const Sight& now) { return now.says("The firmware was updated"); });
  window.click("connection/Continue");
  sight = window.wait_until("the board is back",
                            [](const Sight& now) { return now.connected() && now.state() == "ready"; });
  CHECK_FALSE(sight.says("The firmware was updated"));
}
