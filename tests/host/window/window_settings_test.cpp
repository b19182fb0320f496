// Settings survive a round trip, and damage to their file never keeps the window shut. Layouts and axes.
#include <cmath>
#include <filesystem>

#include <doctest/doctest.h>

#include <protocol/reports.hpp>
#include <window/plot_axis.hpp>
#include <window/window_settings.hpp>

using namespace inkwell;
using namespace inkwell::window;

TEST_CASE("settings come back as they were written") {
  WindowSettings settings;
  settings.theme = Theme::light;
  settings.tuning_width = 412.0f;
  settings.scope_is_shown = false;
  settings.scope_span_s = 0.05;
  settings.trigger = {TriggerMode::single, protocol::Signal::current_2_A, TriggerEdge::falling, -0.25f, 0.5f};
  settings.layout = built_in_layout("currents");
  settings.layout.panes.push_back(
      {PaneKind::xy, "x against \"y\"", {protocol::Signal::position_x_m, protocol::Signal::position_y_m}});
  ScopeLayout mine = built_in_layout("paper");
  mine.name = "My \"paper\"";
  mine.columns = 1;
  settings.own_layouts.save(mine);
  settings.parameters_file = (std::filesystem::temp_directory_path() / "soft wall.toml").string();
  CHECK(parse_settings(format_settings(settings)) == settings);
}

TEST_CASE("a damaged file gives the defaults, and what makes no sense keeps its default") {
  CHECK(parse_settings("[window\ntheme = ") == WindowSettings{});
  CHECK(parse_settings("") == WindowSettings{});
  const WindowSettings settings = parse_settings(
      "[window]\ntheme = \"pink\"\ntuning_width = -5\nscope_height = \"tall\"\n"
      "[scope]\nspan_s = 1e9\npanes = [ { kind = \"time\", signals = [ \"no_such_signal\" ] }, 7 ]\n"
      "[trigger]\nsignal = \"force_N\"\npre_trigger = 3\n");
  CHECK(settings == WindowSettings{});
}

TEST_CASE("layouts name existing signals, and fit into one selection") {
  for (const ScopeLayout& layout : built_in_layouts()) {
    CAPTURE(layout.name);
    CHECK_FALSE(layout.panes.empty());
    CHECK(signals_of(layout).size() <= protocol::scope_signals_maximum);
  }
  CHECK(built_in_layout("paper").panes.size() == 4);
  CHECK(built_in_layout("none of them").name == built_in_layouts().front().name);
}

TEST_CASE("layouts of one's own are saved, replaced, renamed and removed; the built-in ones stay") {
  OwnLayouts own;
  ScopeLayout layout = built_in_layout("currents");
  layout.name = "mine";
  own.save(layout);
  layout.columns = 1;
  own.save(layout);
  REQUIRE(own.all().size() == 1);
  CHECK(layout_named("mine", own).columns == 1);
  CHECK(layout_named("paper", own) == built_in_layout("paper"));

  CHECK_FALSE(OwnLayouts::refusal("paper").empty());
  CHECK_FALSE(OwnLayouts::refusal("  ").empty());
  CHECK(OwnLayouts::refusal("mine").empty());
  layout.name = "other";
  own.save(layout);
  CHECK_FALSE(own.rename("other", "mine").empty());
  CHECK_FALSE(own.rename("other", "paper").empty());
  CHECK(own.rename("other", "third").empty());
  CHECK(own.find("other") == nullptr);
  REQUIRE(own.find("third") != nullptr);
  own.remove("third");
  CHECK(own.all().size() == 1);
  CHECK(built_in_layout("paper").panes.size() == 4);

  layout.name = "paper";  // from a file that somebody edited
  CHECK(OwnLayouts({layout}).all().empty());
}

TEST_CASE("a layout with too many signals asks for as many as can be streamed, each once") {
  ScopeLayout layout{"all", 2, {{PaneKind::time, "a", {}}, {PaneKind::time, "b", {}}}};
  for (const auto& info : protocol::signal_table)
    for (Pane& pane : layout.panes) pane.signals.push_back(static_cast<protocol::Signal>(info.id));
  CHECK(signals_of(layout).size() == protocol::scope_signals_maximum);
}

TEST_CASE("ticks are round numbers inside the range") {
  const auto result = ticks({-0.23, 0.98}, 6);
  REQUIRE(result.size() == 6);
  CHECK(result.front() == doctest::Approx(-0.2));
  CHECK(result.back() == doctest::Approx(0.8));
  CHECK(ticks({1.0, 1.0}, 5).empty());
  CHECK(tick_label(0.25, 0.05) == "0.25");
  CHECK(tick_label(1500.0, 500.0) == "1500");
  CHECK(tick_label(1e-17, 0.5) == "0");
}

TEST_CASE("a range holds its data, also if they are constant or missing") {
  for (const auto& [low, high] : {std::pair{0.0, 3.3}, {-1e-5, 1e-5}, {42.0, 42.0}, {-7e4, 2.0}}) {
    const AxisRange range = enclosing_range(low, high);
    CHECK(range.minimum <= low);
    CHECK(range.maximum >= high);
    CHECK(range.extent() > 0.0);
    CHECK(range.extent() < 2.0 * std::max(high - low, 0.2 * std::abs(low)));
  }
  CHECK(enclosing_range(0.0, 0.0).extent() >= 1.0);
  CHECK(enclosing_range(std::nan(""), std::nan("")).extent() > 0.0);
}

TEST_CASE("an axis grows at once and shrinks only after a while") {
  SteadyRange axis;
  axis.update(0.0, 1.0, 0.0);
  CHECK(axis.update(0.0, 10.0, 0.1).maximum >= 10.0);
  CHECK(axis.update(0.0, 1.0, 0.2).maximum >= 10.0);
  CHECK(axis.update(0.0, 1.0, 1.0).maximum >= 10.0);
  CHECK(axis.update(0.0, 1.0, 2.0).maximum < 2.0);
}

TEST_CASE("the room around a constant gives way to the first change, however small") {
  SteadyRange axis;
  axis.update(0.0, 0.0, 0.0);
  CHECK(axis.update(0.0, 0.003, 0.1).extent() < 0.01);
}
