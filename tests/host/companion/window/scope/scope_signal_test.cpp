// Tests signal groups, signal search, drawing order, and the text of an empty plot.
#include <doctest/doctest.h>

#include <algorithm>

#include "host/companion/window/scope/scope_layout.hpp"

using namespace inkwell;
using namespace inkwell::window;
using protocol::Signal;

TEST_CASE("every signal stands in one group, and groups are found by words") {
  std::size_t count = 0;
  for (const auto& group : signal_groups("")) count += group.signals.size();
  CHECK(count == protocol::signal_count);
  const auto found = signal_groups("Current REFERENCE 2");
  REQUIRE(found.size() == 1);
  CHECK(found[0].signals == std::vector{Signal::current_reference_2_A});
  CHECK(found[0].title == "Currents and duty");
  CHECK(signal_groups("gimbal yaw")[0].signals == std::vector{Signal::gimbal_1_rad});
  CHECK(signal_groups("no such thing").empty());
}

TEST_CASE("references are drawn last, so that they are visible above the signals that follow them") {
  CHECK(drawing_order({Signal::current_reference_1_A, Signal::current_1_A, Signal::duty_1}) ==
        std::vector<std::size_t>{1, 2, 0});
  CHECK(drawing_order({Signal::force_x_N, Signal::force_y_N}) == std::vector<std::size_t>{0, 1});
}

TEST_CASE("an empty plot has a hint that names the next action") {
  SignalHistory history(256);
  const ScopePlot force{PlotKind::time, "Force", {Signal::force_N}};
  CHECK(hint_for(force, history).find("Connect a device") != std::string::npos);
  history.append({{Signal::force_N}, 0, 1, {1.0f}, 0});
  CHECK(hint_for(force, history).empty());
  CHECK(hint_for({PlotKind::time, "Duty", {Signal::duty_1}}, history).find("duty_1") != std::string::npos);
  CHECK(hint_for({PlotKind::xy, "Force", {Signal::force_N}}, history).find("second signal") != std::string::npos);
}

TEST_CASE("force against penetration comes with the window") {
  const ScopeLayout& wall = built_in_layout("wall");
  CHECK(wall.plots[0].kind == PlotKind::xy);
  REQUIRE(wall.plots[0].signals.size() == 2);
  REQUIRE(wall.plots[0].signals[0].formula() != nullptr);
  CHECK(refusal_of(*wall.plots[0].signals[0].formula()).empty());
  CHECK(wall.plots[0].signals[1] == ScopeSignal(Signal::force_N));
}
