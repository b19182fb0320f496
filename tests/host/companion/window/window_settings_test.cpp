// Tests that settings can be written and read, and that a damaged file does not prevent the window from opening.
#include <filesystem>
#include <fstream>
#include <iterator>

#include <doctest/doctest.h>

#include "host/companion/window/window_settings.hpp"
#include "tests/temporary_directory.hpp"

using namespace inkwell;
using namespace inkwell::window;
using inkwell::tests::TemporaryDirectory;

namespace {

std::string text_of(const std::filesystem::path& file) {
  std::ifstream stream(file);
  return {std::istreambuf_iterator<char>(stream), {}};
}

ScopeLayout layout_called(const char* name) {
  ScopeLayout layout = built_in_layout("paper");
  layout.name = name;
  return layout;
}

}  // namespace

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
  CHECK(write_settings(settings, file, {}).empty());
  CHECK(read_settings(file).settings == settings);
  const std::filesystem::directory_iterator left(file.parent_path());
  CHECK(std::distance(left, {}) == 1);  // no temporary file remains
  CHECK(read_settings(directory.file("none.toml")).settings == WindowSettings{});
  CHECK(write_settings(settings, "/proc/none/window.toml", {}).find("/proc/none/window.toml") != std::string::npos);
}

TEST_CASE("a line that is not TOML costs no other setting, and is reported and copied") {
  const TemporaryDirectory directory;
  const std::filesystem::path file = directory / "window.toml";
  const std::string text = "[window]\ntheme = \"light\"\noops = = 1\nscope_part = 0.5\n";
  std::ofstream(file) << text;
  const LoadedSettings loaded = read_settings(file);
  CHECK(loaded.settings.theme == Theme::light);
  CHECK(loaded.settings.scope_part == 0.5f);
  CHECK(loaded.problem.find("line 3") != std::string::npos);
  CHECK(loaded.problem.find(file.string()) != std::string::npos);

  CHECK(write_settings(loaded.settings, file, loaded.settings).empty());
  CHECK(text_of(file) == text);  // unchanged settings are not written
  WindowSettings changed = loaded.settings;
  changed.column_width = 400.0f;
  CHECK(write_settings(changed, file, loaded.settings).empty());
  CHECK(read_settings(file).settings == changed);
  CHECK(read_settings(file).problem.empty());
  CHECK(text_of(damaged_copy(file)) == text);
}

TEST_CASE("settings of a file that never becomes valid TOML are the defaults") {
  for (const char* text : {"plots = [", "\"\"\"", "a = 1\na = 2\n[a]\n[a", "\xFF\xFE"}) {
    CAPTURE(text);
    CHECK(parse_settings(text) == WindowSettings{});
  }
}

TEST_CASE("unknown settings, signals and layouts remain in the file") {
  const TemporaryDirectory directory;
  const std::filesystem::path file = directory / "window.toml";
  std::ofstream(file) << "[window]\nnew_in_3 = 7\ntheme = \"pink\"\n[future]\nx = 1\n"
                         "[scope]\nname = \"law\"\nplots = [ { kind = \"time\", signals = [ \"depth_of_law_m\" ] } ]\n"
                         "layouts = [ { name = \"other law\", plots = [ { signals = [ \"angle_of_law_rad\" ] } ] } ]\n";
  const WindowSettings before = read_settings(file).settings;
  WindowSettings changed = before;
  changed.scope.span_s = 0.25;
  changed.scope.own_layouts.save(layout_called("mine"));
  CHECK(write_settings(changed, file, before).empty());
  const std::string text = text_of(file);
  for (const char* kept : {"new_in_3", "pink", "[future]", "depth_of_law_m", "other law", "angle_of_law_rad", "mine"}) {
    CAPTURE(kept);
    CHECK(text.find(kept) != std::string::npos);
  }
  CHECK(read_settings(file).settings == changed);
}

TEST_CASE("two windows keep the changes of each other") {
  const TemporaryDirectory directory;
  const std::filesystem::path file = directory / "window.toml";
  WindowSettings start;
  start.scope.own_layouts.save(layout_called("first"));
  start.scope.own_layouts.save(layout_called("second"));
  REQUIRE(write_settings(start, file, {}).empty());

  WindowSettings one = start, other = start;
  one.theme = Theme::light;
  one.scope.own_layouts.remove("first");
  one.scope.own_layouts.save(layout_called("third"));
  other.scope.span_s = 0.25;
  ScopeLayout second = layout_called("second");
  second.columns = 1;
  other.scope.own_layouts.save(second);
  REQUIRE(write_settings(one, file, start).empty());
  REQUIRE(write_settings(other, file, start).empty());

  const WindowSettings combined = read_settings(file).settings;
  CHECK(combined.theme == Theme::light);
  CHECK(combined.scope.span_s == 0.25);
  CHECK(combined.scope.own_layouts.find("first") == nullptr);
  REQUIRE(combined.scope.own_layouts.find("second") != nullptr);
  CHECK(*combined.scope.own_layouts.find("second") == second);
  CHECK(combined.scope.own_layouts.find("third") != nullptr);
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
