// Tests views of the window: event log, dragged signals, formulas, an overlaid recording, large displays.
#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "host/client/recording/recording.hpp"

#include "tests/system/window_rig.hpp"

using namespace inkwell;
using namespace inkwell::tests;
using protocol::Signal;

namespace {

std::string content_of(const std::string& file) {
  std::ifstream stream(file);
  return {std::istreambuf_iterator<char>(stream), {}};
}

void change_stiffness(WindowRig& rig, const std::string& value) {
  const auto before = rig.look().applied_at_periods();
  rig.click("tabs/Tuning");
  rig.enter("tuning/wall_stiffness_N_per_m", value);
  rig.press_key("Return");
  rig.wait_until("it took effect", [&](const Sight& now) { return now.applied_at_periods() != before; });
}

}  // namespace

TEST_CASE("events are logged, saved as text, and marked in the recording at the control period of the board") {
  const TemporaryDirectory directory;
  const std::string file = directory.file("push.h5");
  WindowRig rig;
  rig.click("tabs/Recording");
  rig.enter("recording/file", file);
  rig.click("recording/Start recording");
  rig.wait_until("it records", [](const Sight& now) { return now.has("recording/Stop recording"); });
  rig.control.run(0.2);
  rig.control.resume();
  change_stiffness(rig, "600");
  const auto applied_at_periods = rig.look().applied_at_periods();
  rig.switch_force_on();
  rig.click("tabs/Log");
  rig.wait_until("the change is told",
                 [](const Sight& now) { return now.says("wall_stiffness_N_per_m = 600.0, was 800.0"); });
  CHECK(rig.look().says("The force is on."));
  CHECK(rig.look().says("Connected to the simulation"));

  rig.click("log/Save as text");
  rig.enter("choose a file/path", directory.file("log.txt"));
  rig.click("choose a file/Save");
  rig.wait_until("the dialog is over", [](const Sight& now) { return !now.has("choose a file/Save"); });
  CHECK(content_of(directory.file("log.txt")).find("parameter   wall_stiffness_N_per_m = 600.0, was 800.0") !=
        std::string::npos);

  rig.click("tabs/Recording");
  rig.click("recording/Stop recording");
  rig.wait_until("it is complete", [](const Sight& now) { return now.says("push.h5 is complete"); });
  const auto marks = recording::read(file).marks;
  const auto change = std::ranges::find(marks, device::EventKind::parameter, &recording::Mark::kind);
  REQUIRE(change != marks.end());
  CHECK(change->period == applied_at_periods);
  CHECK(change->text == "wall_stiffness_N_per_m = 600.0, was 800.0");
  CHECK(std::ranges::count(marks, device::EventKind::force, &recording::Mark::kind) == 1);
  const auto log = run_program("inkwell", {"replay", file, "--log"});
  CHECK(log.exit_code == 0);
  CHECK(log.out.find("parameter   wall_stiffness_N_per_m = 600.0, was 800.0") != std::string::npos);
}

TEST_CASE("a signal is found by a word and dragged into a plot, and a formula is drawn") {
  WindowRig rig({"--layout", "contact"});
  rig.click("scope/Signals");
  rig.enter("scope/search", "supply");
  const auto row =
      rig.wait_until("it is found", [](const Sight& now) { return now.has("scope/supply_V"); }).item("scope/supply_V");
  const auto plots = rig.look().item("scope/Position");
  CHECK_FALSE(rig.look().says("supply"));
  rig.drag(row.centre(), {plots.x + 120, plots.y + 80});
  rig.release_mouse();
  rig.wait_until("it is in the plot's legend", [](const Sight& now) { return now.says("supply"); });

  rig.click("scope/New formula");
  rig.enter("formula/formula", "force_N +");
  rig.wait_until("it is refused", [](const Sight& now) { return now.says("formula is incomplete"); });
  CHECK_FALSE(rig.look().can_click("formula/Draw signal"));
  rig.enter("formula/formula", "force_x_N - force_y_N");
  rig.enter("formula/name of formula", "difference_N");
  rig.wait_until("it has a unit", [](const Sight& now) { return now.says("Unit of the plot: N."); });
  rig.click("formula/Draw signal");
  rig.wait_until("it has a plot", [](const Sight& now) { return now.has("scope/difference_N"); });
}

TEST_CASE("the window reports that no program answers at the address") {
  WindowRig rig;
  rig.control.usb(false);
  rig.wait_until("no arm is there", [](const Sight& now) { return now.says("No arm was found"); });
  rig.control.quit();
  rig.wait_until("nobody answers", [answer = "No program answers at " + rig.board.usbip().text()](const Sight& now) {
    return now.says(answer);
  });
}

TEST_CASE("where there is no device, a button starts a virtual one") {
  WindowRig rig;
  rig.control.usb(false);
  rig.wait_until("it is offered", [](const Sight& now) { return now.can_click("connection/Start virtual board"); });
  for (int step = 0; step < 12 && rig.look().with_keyboard() != "connection/Start virtual board"; ++step)
    rig.tap_key("ctrl+Tab");
  rig.tap_key("Return");
  rig.wait_until("its arm is there", [](const Sight& now) { return now.state() == "ready"; });
  CHECK(rig.look().connected());
}
