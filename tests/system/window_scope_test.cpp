// Tests the scope of the window: the captured minute, the frozen fault, statistics and the files of plots.
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

namespace {

std::string content_of(const std::string& file) {
  std::ifstream stream(file);
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// Returns the first text of the window that ends with `ending`, without the ending.
std::string text_before(const Sight& sight, const std::string& ending) {
  for (const auto& each : sight.all.at("texts"))
    if (const auto text = each.get<std::string>(); text.ends_with(ending))
      return text.substr(0, text.size() - ending.size());
  return {};
}

}  // namespace

TEST_CASE("the last minute is saved without a recording, with marks and events before the request") {
  WindowRig rig;
  rig.switch_force_on();
  rig.control.run(0.5);
  rig.control.resume();
  rig.press_key("ctrl+m");
  rig.control.run(0.5);
  rig.control.resume();
  rig.click("tabs/Recording");
  rig.click("recording/Save last 60 s");
  const auto saved = rig.wait_until("it is saved", [](const Sight& now) { return now.says(" is complete."); });
  const std::string file = text_before(saved, " is complete.");
  CAPTURE(file);
  const auto recording = recording::read(file);
  std::filesystem::remove(file);
  CHECK(recording.complete);
  CHECK(recording.duration_s() > 1.0);
  CHECK_NOTHROW(recording.column(protocol::Signal::joint_1_rad));  // needed for a replay
  CHECK(std::ranges::count(recording.marks, device::EventKind::mark, &recording::Mark::kind) == 1);
  CHECK(std::ranges::count(recording.marks, device::EventKind::force, &recording::Mark::kind) == 1);
}

TEST_CASE("keys and the top bar start, mark and stop a recording") {
  const TemporaryDirectory directory;
  const std::string file = directory.file("keys.h5");
  WindowRig rig;
  rig.click("tabs/Recording");
  rig.enter("recording/file", file);
  rig.click("tabs/Tuning");
  rig.press_key("ctrl+r");
  rig.wait_until("it records", [](const Sight& now) { return now.can_click("status/Stop recording"); });
  rig.control.run(0.2);
  rig.control.resume();
  rig.press_key("ctrl+m");
  rig.click("status/Mark");
  rig.click("status/Stop recording");
  rig.wait_until("it has stopped", [](const Sight& now) { return now.can_click("status/Record"); });
  const auto recording = recording::read(file);
  CHECK(recording.complete);
  CHECK(std::ranges::count(recording.marks, device::EventKind::mark, &recording::Mark::kind) == 2);
}

TEST_CASE("a fault freezes the scope, the banner shows the signals, and the scope runs again with the force") {
  WindowRig rig({"--flat-colours", "--layout", "contact"});
  rig.control.run(0.5);
  rig.control.resume();
  rig.click("status/Scope");
  rig.wait_until("the scope is hidden", [](const Sight& now) { return !now.has("scope/Pause"); });
  rig.control.supply(6.0);
  rig.click("banner/Show signals");
  const auto frozen = rig.wait_until("the fault is shown", [](const Sight& now) {
    return now.says("Frozen at the fault") && now.has("scope/fault") && now.has("scope/Run");
  });
  const Item plot = frozen.item("scope/fault");
  rig.control.run(1.0);
  rig.control.resume();
  CHECK(rig.look().item("scope/fault").x == plot.x);
  rig.control.supply(18.0);
  rig.click("banner/Clear fault");
  rig.wait_until("it is cleared",
                 [](const Sight& now) { return now.state() == "ready" || now.state() == "unreferenced"; });
  CHECK(rig.look().says("Frozen at the fault"));
  if (rig.look().state() == "unreferenced") rig.click("scene/Into the inkwell");
  rig.switch_force_on();
  rig.wait_until("the scope runs", [](const Sight& now) { return now.has("scope/Pause"); });
}

TEST_CASE("statistics have units, and a plot is saved as values, drawing and picture") {
  const TemporaryDirectory directory;
  WindowRig rig({"--flat-colours", "--layout", "contact"});
  rig.control.run(0.5);
  rig.control.resume();
  rig.press_key("ctrl+p");
  rig.wait_until("it pauses", [](const Sight& now) { return now.has("scope/Run"); });
  CHECK(rig.look().says("mm"));
  rig.click("scope/Statistics");
  rig.wait_until("the statistics have a unit", [](const Sight& now) { return !text_before(now, " mm").empty(); });
  const auto save = [&](const std::string& row, const std::string& name) {
    rig.click("scope/Position");
    rig.click_in_menu(row);
    const std::string file = directory.file(name);
    rig.enter("choose a file/path", file);
    rig.click("choose a file/Save");
    rig.wait_until(name + " is saved", [&](const Sight& now) { return now.says("Saved " + file); });
    return file;
  };
  const std::string csv = content_of(save("Save values (CSV)", "plot.csv"));
  CHECK(csv.starts_with("time_s,"));
  CHECK(csv.find("position_x_m") != std::string::npos);
  CHECK(std::ranges::count(csv, '\n') > 1000);
  CHECK(content_of(save("Save drawing (SVG)", "plot.svg")).find("<polyline") != std::string::npos);
  const Image image = read_png(save("Save picture (PNG)", "plot.png"));
  CHECK(image.width > 200);
  CHECK(image.height > 90);
  CHECK(image.colours() > 10);
  rig.click("scope/Position");
  rig.click_in_menu("Copy statistics");
  rig.wait_until("it is copied", [](const Sight& now) { return now.says("Copied the statistics."); });
}

TEST_CASE("the menu of a plot lists the plotted signals first, and fixes the range of the y axis") {
  WindowRig rig({"--flat-colours", "--layout", "contact"});
  rig.click("scope/Position");
  const auto menu =
      rig.wait_until("the menu is open", [](const Sight& now) { return !now.in_menu("Fixed y range").empty(); });
  CHECK(menu.says("Plotted"));
  CHECK_FALSE(menu.in_menu("position_x_m").empty());
  CHECK(menu.item(menu.in_menu("position_x_m")).y < menu.item(menu.in_menu("search")).y);
  rig.click_in_menu("Fixed y range");
  const auto fixed =
      rig.wait_until("the fields are there", [](const Sight& now) { return !now.in_menu("range minimum").empty(); });
  CHECK_FALSE(fixed.in_menu("range maximum").empty());
  rig.enter(fixed.in_menu("range maximum"), "250");
  rig.press_key("Return");
  rig.enter(fixed.in_menu("range minimum"), "-50");
  rig.click(rig.look().item("scene/view").at(0.9, 0.2));  // a click elsewhere confirms the number and closes the menu
  rig.wait_until("the menu is closed", [](const Sight& now) { return now.in_menu("Fixed y range").empty(); });
  CHECK(rig.look().all.at("plot_ranges").at("Position") == nlohmann::json{-0.05, 0.25});
}

TEST_CASE("a recording does not erase the scope, and a replay has one button Pause") {
  const TemporaryDirectory directory;
  const std::string file = directory.file("push.h5");
  WindowRig rig({"--flat-colours", "--layout", "contact"});
  rig.click("tabs/Recording");
  rig.enter("recording/file", file);
  rig.click("recording/Start recording");
  rig.control.run(0.3);
  rig.control.resume();
  rig.click("recording/Stop recording");
  rig.wait_until("it is complete", [](const Sight& now) { return now.says("push.h5 is complete"); });
  rig.click("recording/Replay last recording");
  const auto replay = rig.wait_until("it plays", [](const Sight& now) { return now.says("REPLAY"); });
  CHECK(replay.has("replay/Close replay"));
  CHECK_FALSE(replay.has("scope/Pause"));
}
