#include "host/companion/window/window_settings.hpp"

#include <algorithm>
#include <array>
#include <fstream>
#include <optional>
#include <sstream>
#include <system_error>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <toml++/toml.h>

#include "host/client/local/configuration_folder.hpp"
#include "host/client/local/replaced_file.hpp"

namespace inkwell::window {

namespace {

constexpr float points_maximum = 10'000.0f;  // larger than any display
constexpr std::array<std::string_view, 2> theme_names{"dark", "light"};
constexpr auto plot_kind_names = std::to_array<std::string_view>({"time", "spectrum", "xy"});
static_assert(plot_kind_names.size() == plot_kind_count);
constexpr std::array<std::string_view, 3> trigger_mode_names{"off", "normal", "single"};
constexpr std::array<std::string_view, 2> trigger_edge_names{"rising", "falling"};

template <class Enumeration, std::size_t count>
std::string_view name_of(Enumeration value, const std::array<std::string_view, count>& names) {
  return names[static_cast<std::size_t>(value)];
}

template <class Enumeration, std::size_t count>
void read_name(toml::node_view<const toml::node> node, const std::array<std::string_view, count>& names,
               Enumeration& value) {
  const auto found = std::ranges::find(names, node.value_or(std::string_view{}));
  if (found != names.end()) value = static_cast<Enumeration>(found - names.begin());
}

template <class Number>
void read_number(toml::node_view<const toml::node> node, Number minimum, Number maximum, Number& value) {
  if (const auto number = node.value<double>(); number && *number >= minimum && *number <= maximum)
    value = static_cast<Number>(*number);
}

toml::table to_toml(const ScopePlot& plot) {
  toml::array signals;
  for (const ScopeSignal& signal : plot.signals) signals.push_back(signal.name());
  toml::table table{
      {"kind", name_of(plot.kind, plot_kind_names)}, {"title", plot.title}, {"signals", std::move(signals)}};
  if (plot.fixed_range) table.insert("y_range", toml::array{plot.fixed_range->minimum, plot.fixed_range->maximum});
  return table;
}

toml::array to_toml(const std::vector<Formula>& formulas) {
  toml::array array;
  for (const Formula& formula : formulas)
    array.push_back(toml::table{{"name", formula.name},
                                {"formula", formula.text},
                                {"unit", formula.unit},
                                {"low_pass_Hz", formula.low_pass_Hz}});
  return array;
}

/// Returns the valid formulas.
std::vector<Formula> formulas_from(const toml::array* array) {
  std::vector<Formula> formulas;
  if (array == nullptr) return formulas;
  for (const auto& each : *array) {
    const toml::table* table = each.as_table();
    if (table == nullptr) continue;
    Formula formula{.name = (*table)["name"].value_or(std::string{}),
                    .text = (*table)["formula"].value_or(std::string{}),
                    .unit = (*table)["unit"].value_or(std::string{})};
    read_number((*table)["low_pass_Hz"], 0.0, Formula::low_pass_maximum_Hz, formula.low_pass_Hz);
    const bool is_new = std::ranges::find(formulas, formula.name, &Formula::name) == formulas.end();
    if (is_new && refusal_of(formula).empty()) formulas.push_back(std::move(formula));
  }
  return formulas;
}

std::optional<ScopePlot> plot_from(const toml::table& table, const std::vector<Formula>& formulas) {
  ScopePlot plot;
  read_name(toml::node_view<const toml::node>(table["kind"]), plot_kind_names, plot.kind);
  plot.title = table["title"].value_or(std::string{});
  if (const toml::array* signals = table["signals"].as_array())
    for (const auto& each : *signals)
      if (const auto signal = find_scope_signal(each.value_or(std::string_view{}), formulas))
        plot.signals.push_back(*signal);
  if (const toml::array* range = table["y_range"].as_array(); range != nullptr && range->size() == 2) {
    const auto minimum = (*range)[0].value<double>(), maximum = (*range)[1].value<double>();
    if (minimum && maximum && *minimum < *maximum) plot.fixed_range = FixedRange{*minimum, *maximum};
  }
  if (plot.signals.empty()) return std::nullopt;
  return plot;
}

toml::array to_toml(const std::vector<ScopePlot>& plots) {
  toml::array array;
  for (const ScopePlot& plot : plots) array.push_back(to_toml(plot));
  return array;
}

std::optional<ScopeLayout> layout_from(const toml::table& table) {
  ScopeLayout layout{table["name"].value_or(std::string{}), 2, {}, formulas_from(table["formulas"].as_array())};
  read_number(table["columns"], 1, 4, layout.columns);
  if (const toml::array* plots = table["plots"].as_array())
    for (const auto& each : *plots)
      if (const toml::table* plot_table = each.as_table())
        if (auto plot = plot_from(*plot_table, layout.formulas)) layout.plots.push_back(std::move(*plot));
  if (layout.plots.empty()) return std::nullopt;
  return layout;
}

/// Converts settings of the file. Each invalid value is replaced by its default.
WindowSettings settings_from(const toml::table& root) {
  WindowSettings settings;
  const auto window = root["window"];
  read_name(window["theme"], theme_names, settings.theme);
  read_number(window["tuning_width"], WindowSettings::column_width_minimum, points_maximum, settings.column_width);
  read_number(window["scope_part"], WindowSettings::scope_part_minimum, WindowSettings::scope_part_maximum,
              settings.scope_part);
  settings.scope_is_shown = window["scope_is_shown"].value_or(settings.scope_is_shown);
  settings.parameters_file = window["parameters_file"].value_or(std::string{});

  const auto scope = root["scope"];
  read_number(scope["span_s"], ScopeSettings::span_minimum_s, ScopeSettings::span_maximum_s, settings.scope.span_s);
  if (const toml::table* table = scope.as_table())
    if (auto layout = layout_from(*table)) settings.scope.layout = std::move(*layout);
  if (const toml::array* layouts = scope["layouts"].as_array()) {
    std::vector<ScopeLayout> own;
    for (const auto& each : *layouts)
      if (const toml::table* table = each.as_table())
        if (auto layout = layout_from(*table)) own.push_back(std::move(*layout));
    settings.scope.own_layouts = OwnLayouts(std::move(own));
  }

  const auto trigger = root["trigger"];
  read_name(trigger["mode"], trigger_mode_names, settings.scope.trigger.mode);
  read_name(trigger["edge"], trigger_edge_names, settings.scope.trigger.edge);
  if (const auto signal = protocol::find_signal(trigger["signal"].value_or(std::string_view{})))
    settings.scope.trigger.signal = *signal;
  read_number(trigger["level"], -1e6f, 1e6f, settings.scope.trigger.level);
  read_number(trigger["pre_trigger"], 0.0f, 1.0f, settings.scope.trigger.pre_trigger);
  return settings;
}

std::string text_of(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

struct ReadText {
  toml::table table;
  std::string problem;  ///< states the first line that is not TOML
};

/// Replaces the last line up to `line` that has text by an empty line. Returns false if no such line exists.
bool remove_line(std::vector<std::string>& lines, std::size_t line) {
  for (std::size_t i = std::min(line, lines.size()); i > 0; --i)
    if (lines[i - 1].find_first_not_of(" \t\r") != std::string::npos) {
      lines[i - 1].clear();
      return true;
    }
  return false;
}

/// Reads TOML, and ignores the lines that are not TOML.
ReadText read_lines(const std::string& text) {
  ReadText read;
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  for (;;) {
    try {
      read.table = toml::parse(fmt::format("{}\n", fmt::join(lines, "\n")));
      return read;
    } catch (const toml::parse_error& error) {
      const auto line = static_cast<std::size_t>(error.source().begin.line);
      if (read.problem.empty()) read.problem = fmt::format("line {}: {}", line, error.description());
      if (!remove_line(lines, line) && !remove_line(lines, lines.size())) return read;
    }
  }
}

std::string format(const toml::table& table) {
  std::ostringstream text;
  text << table << '\n';
  return text.str();
}

toml::table& section(toml::table& file, std::string_view name) {
  if (!file[name].is_table()) file.insert_or_assign(name, toml::table{});
  return *file[name].as_table();
}

toml::table to_toml(const ScopeLayout& layout) {
  return toml::table{{"name", layout.name},
                     {"columns", layout.columns},
                     {"plots", to_toml(layout.plots)},
                     {"formulas", to_toml(layout.formulas)}};
}

bool is_equal(const ScopeLayout* one, const ScopeLayout* other) {
  return one == other || (one != nullptr && other != nullptr && *one == *other);
}

/// Combines the layouts of the file with the changes of this window.
toml::array combine(const toml::array* file, const OwnLayouts& own, const OwnLayouts& before) {
  toml::array combined;
  std::vector<std::string> in_file;
  if (file != nullptr)
    for (const auto& each : *file) {
      const toml::table* table = each.as_table();
      const std::string name = table == nullptr ? std::string() : (*table)["name"].value_or(std::string());
      const ScopeLayout* layout = own.find(name);
      in_file.push_back(name);
      if (is_equal(layout, before.find(name)))
        combined.push_back(each);
      else if (layout != nullptr)
        combined.push_back(to_toml(*layout));
    }
  for (const ScopeLayout& layout : own.all())
    if (std::ranges::find(in_file, layout.name) == in_file.end() && !is_equal(&layout, before.find(layout.name)))
      combined.push_back(to_toml(layout));
  return combined;
}

/// Writes the settings that differ from `before` into the table. The other settings, which another window or another
/// version may have written, remain. Without `before`, writes all settings.
void apply(toml::table& file, const WindowSettings& settings, const WindowSettings* before) {
  const auto set = [&](std::string_view where, std::string_view key, auto member, auto convert) {
    if (before == nullptr || member(settings) != member(*before))
      section(file, where).insert_or_assign(key, convert(member(settings)));
  };
  const auto as_it_is = [](auto value) { return value; };
  set(
      "window", "theme", [](const WindowSettings& of) { return of.theme; },
      [](Theme theme) { return name_of(theme, theme_names); });
  set(
      "window", "tuning_width", [](const WindowSettings& of) { return of.column_width; }, as_it_is);
  set(
      "window", "scope_part", [](const WindowSettings& of) { return of.scope_part; }, as_it_is);
  set(
      "window", "scope_is_shown", [](const WindowSettings& of) { return of.scope_is_shown; }, as_it_is);
  set(
      "window", "parameters_file", [](const WindowSettings& of) { return of.parameters_file.string(); }, as_it_is);
  set(
      "scope", "span_s", [](const WindowSettings& of) { return of.scope.span_s; }, as_it_is);
  if (before == nullptr || settings.scope.layout != before->scope.layout)
    for (auto& [key, value] : to_toml(settings.scope.layout)) section(file, "scope").insert_or_assign(key, value);
  toml::table& scope = section(file, "scope");
  scope.insert_or_assign("layouts", combine(scope["layouts"].as_array(), settings.scope.own_layouts,
                                            before == nullptr ? OwnLayouts() : before->scope.own_layouts));
  set(
      "trigger", "mode", [](const WindowSettings& of) { return of.scope.trigger.mode; },
      [](TriggerMode mode) { return name_of(mode, trigger_mode_names); });
  set(
      "trigger", "signal", [](const WindowSettings& of) { return of.scope.trigger.signal; },
      [](protocol::Signal signal) { return protocol::info(signal).name; });
  set(
      "trigger", "edge", [](const WindowSettings& of) { return of.scope.trigger.edge; },
      [](TriggerEdge edge) { return name_of(edge, trigger_edge_names); });
  set(
      "trigger", "level", [](const WindowSettings& of) { return of.scope.trigger.level; }, as_it_is);
  set(
      "trigger", "pre_trigger", [](const WindowSettings& of) { return of.scope.trigger.pre_trigger; }, as_it_is);
}

}  // namespace

std::filesystem::path window_settings_path() {
  const auto folder = local::configuration_folder();
  return folder.empty() ? folder : folder / "window.toml";
}

LoadedSettings read_settings(const std::filesystem::path& file) {
  const ReadText read = read_lines(text_of(file));
  LoadedSettings loaded{settings_from(read.table), {}};
  if (!read.problem.empty())
    loaded.problem = fmt::format("The window settings {}, {}. This part is ignored. Correct it, or remove the file.",
                                 file.string(), read.problem);
  return loaded;
}

std::string write_settings(const WindowSettings& settings, const std::filesystem::path& file,
                           const WindowSettings& before) {
  std::error_code ignored;
  std::filesystem::create_directories(file.parent_path(), ignored);
  const bool is_new = !std::filesystem::exists(file, ignored);
  if (!is_new && settings == before) return {};
  try {
    const std::string text = text_of(file);
    ReadText current = read_lines(text);
    if (!current.problem.empty()) local::replace_file(damaged_copy(file), text);
    apply(current.table, settings, is_new ? nullptr : &before);
    local::replace_file(file, format(current.table));
    return {};
  } catch (const std::system_error& error) {
    return fmt::format("The window settings could not be written to {}: {}. Check that the disk is not full.",
                       file.string(), error.code().message());
  }
}

std::filesystem::path damaged_copy(const std::filesystem::path& file) {
  std::filesystem::path copy = file;
  return copy.replace_extension(".damaged.toml");
}

std::string format_settings(const WindowSettings& settings) {
  toml::table file;
  apply(file, settings, nullptr);
  return format(file);
}

WindowSettings parse_settings(const std::string& text) { return settings_from(read_lines(text).table); }

}  // namespace inkwell::window
