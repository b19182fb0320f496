// Tests that settings can be written and read, and that a damaged file does not prevent the window from opening.
#include <filesystem>
#include <iterator>

#include <doctest/doctest.h>

#include "host/companion/window/window_settings.hpp"
#include "tests/temporary_directory.hpp"

using namespace inkwell;
using namespace inkwell::window;
using inkwell::tests::TemporaryDirectory;

TEST_CASE("settings come back as they were written") {
  WindowSettings settings;
  settings.theme = Theme::light;
  settings.column_width = 912.0f;  // half of a wide display
  settings.scope_is_shown = false;
  settings.scope_part = 0.625f;
  settings.scope.span_s = 0.05;
  settings.scope.trigger = {TriggerMode::single, protocol::Signal::current_2_A, TriggerEdge::falling, -0.25f, 0.5f};
  settings.scope.layout = built_in_layout("currents");
  settings.scope.layout.plots.push_back(
      {PlotKind::xy, "x against \"y\"", {protocol::Signal::position_x_m, protocol::Signal::position_y_m}});
  const Formula work{.name = "power", .text = "force_x_N * velocity_x_m_s", .unit = "W", .low_pass_Hz = 50.0};
  settings.scope.layout.formulas.push_back(work);
  settings.scope.layout.plots.push_back({PlotKind::time, "Power", {ScopeSignal(work)}});
  ScopeLayout mine = built_in_layout("paper");
  mine.name = "My \"paper\"";
  mine.columns = 1;
  settings.scope.own_layouts.save(mine);
  settings.parameters_file = (std::filesystem::temp_directory_path() / "soft wall.toml").string();
  CHECK(parse_settings(format_settings(settings)) == settings);
}

TEST_CASE("settings that a Windows editor has saved are read") {
  const WindowSettings settings = parse_settings("\xEF\xBB\xBF[window]\r\ntheme = \"light\"\r\n\r\n");
  CHECK(settings.theme == Theme::light);
}

TEST_CASE("a damaged file or an invalid value in the settings produces the defaults") {
  CHECK(parse_settings("[window\ntheme = ") == WindowSettings{});
  CHECK(parse_settings("") == WindowSettings{});
  const WindowSettings settings = parse_settings(
      "[window]\ntheme = \"pink\"\ntuning_width = -5\nscope_part = 7\n"
      "[scope]\nspan_s = 1e9\npanes = [ { kind = \"time\", signals = [ \"no_such_signal\" ] }, 7 ]\n"
      "[trigger]\nsignal = \"force_N\"\npre_trigger = 3\n");
  CHECK(settings == WindowSettings{});
}

TEST_CASE("a formula that cannot be read is left out, with the plot that showed it") {
  const WindowSettings settings = parse_settings(
      "[scope]\nname = \"mine\"\n"
      "formulas = [ { name = \"bad\", formula = \"force_N +\", unit = \"N\" },"
      " { name = \"good\", formula = \"force_N + 1\", unit = \"N\" } ]\n"
      "plots = [ { kind = \"time\", signals = [ \"bad\" ] }, { kind = \"time\", signals = [ \"good\" ] } ]\n");
  REQUIRE(settings.scope.layout.formulas.size() == 1);
  REQUIRE(settings.scope.layout.plots.size() == 1);
  CHECK(settings.scope.layout.plots[0].signals[0].name() == "good");
}

TEST_CASE("settings are written to a file in a new folder, and a write error is reported") {
  const TemporaryDirectory directory;
  const std::filesystem::path file = directory.file("inkwell/window.toml");
  WindowSettings settings;
  settings.theme = Theme::light;
  CHECK(write_settings(settings, file).empty());
  CHECK(read_settings(file) == settings);
  const std::filesystem::directory_iterator left(file.parent_path());
  CHECK(std::distance(left, {}) == 1);  // no temporary file remains
  CHECK(read_settings(directory.file("none.toml")) == WindowSettings{});
  CHECK(write_settings(settings, "/proc/none/window.toml").find("/proc/none/window.toml") != std::string::npos);
}

TEST_CASE("the fixed range of a plot is saved, and a reversed range is ignored") {
  WindowSettings settings;
  settings.scope.layout.plots.front().fixed_range = FixedRange{-0.5, 1.5};
  CHECK(parse_settings(format_settings(settings)) == settings);
  const WindowSettings reversed =
      parse_settings("[scope]\nname = \"own\"\n[[scope.plots]]\nsignals = [\"force_N\"]\ny_range = [2.0, 1.0]\n");
  REQUIRE(reversed.scope.layout.plots.size() == 1);
  CHECK_FALSE(reversed.scope.layout.plots[0].fixed_range.has_value());
}
