// Tests two recordings in the window: a replayed recording and an overlaid recording.
#include <doctest/doctest.h>

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <numbers>
#include <string>

#include "host/client/recording/recording.hpp"
#include "host/client/recording/signals.hpp"
#include "host/client/recording/writer.hpp"

#include "tests/system/window_rig.hpp"

using namespace inkwell;
using namespace inkwell::tests;
using protocol::Signal;

namespace {

/// Writes a recording of half a second with `times` oscillations of the force between -1 N and 1 N.
void write_swing(const std::string& file, double times) {
  constexpr std::uint32_t periods = protocol::servo_rate_Hz / 2, first_period = 1000;
  const auto signals = recording::standard_signals();
  auto swing =
      recording::Recording::without_samples({.parameters = protocol::default_parameters(), .signals = signals});
  for (std::uint32_t i = 0; i < periods; ++i) {
    const double angle_rad = 2 * std::numbers::pi * times * i / periods;
    swing.periods.push_back(first_period + i);
    for (std::size_t j = 0; j < signals.size(); ++j)
      swing.columns[j].push_back(signals[j] == Signal::force_N ? static_cast<float>(std::sin(angle_rad)) : 0.0f);
  }
  std::filesystem::create_directories(std::filesystem::path(file).parent_path());
  recording::save(swing, file);
}

Sight lay_over(WindowRig& rig, const std::string& file) {
  rig.click("replay/Overlay");
  rig.enter("choose a file/path", file);
  rig.click("choose a file/Overlay");
  return rig.wait_until("it is laid over", [](const Sight& now) { return now.has("replay/over"); });
}

/// Moves the mouse away from all items and returns a picture of the window.
Image picture_of(WindowRig& rig) {
  rig.move_to({700, 60});
  rig.look();
  return rig.picture();
}

/// Returns the number of pixels that differ in the area of the plots.
std::size_t changed_in_plots(WindowRig& rig, const Image& one, const Image& other) {
  const Sight sight = rig.look();
  const Item bar = sight.item("replay/Close replay"), panes = sight.item("tabs/Tuning");
  std::size_t changed = 0;
  for (auto y = static_cast<std::size_t>(bar.y + 2 * bar.height); y < one.height; ++y)
    for (std::size_t x = 0; x < static_cast<std::size_t>(panes.x); ++x) {
      const auto a = one.at(x, y), b = other.at(x, y);
      changed += a.red != b.red || a.green != b.green || a.blue != b.blue ? 1 : 0;
    }
  return changed;
}

/// A shift of the curves by one sample changes fewer pixels than this number.
constexpr std::size_t of_a_sample = 100;

}  // namespace

TEST_CASE("a second recording is drawn over the replayed recording and can be removed") {
  const TemporaryDirectory directory;
  const std::string soft = directory.file("soft.h5"), stiff = directory.file("stiff.csv");
  write_swing(soft, 3);
  write_swing(stiff, 7);
  WindowRig rig({"--layout", "contact", "replay", soft});
  rig.wait_until("it plays to its end", [](const Sight& now) { return now.has("replay/Play"); });
  const Image alone = picture_of(rig);
  REQUIRE(changed_in_plots(rig, alone, picture_of(rig)) == 0);

  const Sight both = lay_over(rig, stiff);
  CHECK(both.says("soft"));
  CHECK(both.says("stiff"));
  CHECK(changed_in_plots(rig, alone, picture_of(rig)) > 10 * of_a_sample);

  rig.click("replay/over");
  rig.click("##Combo_00/Remove overlay");
  rig.wait_until("it is away", [](const Sight& now) { return now.has("replay/Overlay"); });
  CHECK(changed_in_plots(rig, alone, picture_of(rig)) < of_a_sample);

  const auto position = [](const Sight& sight) {
    for (const auto& each : sight.all.at("texts"))
      if (const auto text = each.get<std::string>(); text.ends_with(" s") && text.find(" of ") != std::string::npos)
        return text;
    return std::string();
  };
  const std::string at_the_end = position(rig.look());
  REQUIRE(!at_the_end.empty());
  rig.tap_key("shift+Left");  // the replay bar was clicked last and has the keyboard focus
  rig.wait_until("the position is another", [&](const Sight& now) { return position(now) != at_the_end; });
}

TEST_CASE("the window shows the folders of two recordings with the same name") {
  const TemporaryDirectory directory;
  const std::string monday = directory.file("monday/push.csv"), tuesday = directory.file("tuesday/push.csv");
  write_swing(monday, 3);
  write_swing(tuesday, 7);
  WindowRig rig({"replay", monday});
  CHECK_FALSE(rig.look().says("monday"));
  const Sight both = lay_over(rig, tuesday);
  CHECK(both.says("monday/push"));
  CHECK(both.says("tuesday/push"));
}
