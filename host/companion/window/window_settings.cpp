#include "host/companion/window/window_settings.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <fstream>
#include <optional>
#include <sstream>
#include <system_error>

#include <fmt/format.h>
#include <toml++/toml.h>

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

}  // namespace

std::filesystem::path window_settings_path() {
  if (const char* configuration = std::getenv("XDG_CONFIG_HOME"); configuration != nullptr && *configuration == '/')
    return std::filesystem::path(configuration) / "inkwell" / "window.toml";
  if (const char* home = std::getenv("HOME"); home != nullptr && *home == '/')
    return std::filesystem::path(home) / ".config" / "inkwell" / "window.toml";
  return {};
}

WindowSettings read_settings(const std::filesystem::path& file) {
  std::ifstream stream(file);
  std::ostringstream text;
  text << stream.rdbuf();
  return parse_settings(text.str());
}

std::string write_settings(const WindowSettings& settings, const std::filesystem::path& file) {
  std::error_code ignored;
  std::filesystem::create_directories(file.parent_path(), ignored);
  try {
    local::replace_file(file, format_settings(settings));
    return {};
  } catch (const std::system_error& error) {
    return fmt::format("The window settings could not be written to {}: {}. Check that the disk is not full.",
                       file.string(), error.code().message());
  }
}

std::string format_settings(const WindowSettings& settings) {
  toml::array own_layouts;
  for (const ScopeLayout& layout : settings.scope.own_layouts.all())
    own_layouts.push_back(toml::table{{"name", layout.name},
                                      {"columns", layout.columns},
                                      {"plots", to_toml(layout.plots)},
                                      {"formulas", to_toml(layout.formulas)}});
  const toml::table file{{"window", toml::table{{"theme", name_of(settings.theme, theme_names)},
                                                {"tuning_width", settings.column_width},
                                                {"scope_part", settings.scope_part},
                                                {"scope_is_shown", settings.scope_is_shown},
                                                {"parameters_file", settings.parameters_file.string()}}},
                         {"scope", toml::table{{"name", settings.scope.layout.name},
                                               {"columns", settings.scope.layout.columns},
                                               {"span_s", settings.scope.span_s},
                                               {"plots", to_toml(settings.scope.layout.plots)},
                                               {"formulas", to_toml(settings.scope.layout.formulas)},
                                               {"layouts", std::move(own_layouts)}}},
                         {"trigger", toml::table{{"mode", name_of(settings.scope.trigger.mode, trigger_mode_names)},
                                                 {"signal", protocol::info(settings.scope.trigger.signal).name},
                                                 {"edge", name_of(settings.scope.trigger.edge, trigger_edge_names)},
                                                 {"level", settings.scope.trigger.level},
                                                 {"pre_trigger", settings.scope.trigger.pre_trigger}}}};
  std::ostringstream text;
  text << file << '\n';
  return text.str();
}

WindowSettings parse_settings(const std::string& text) {
  WindowSettings settings;
  toml::table file;
  try {
    file = toml::parse(text);
  } catch (const toml::parse_error&) {
    return settings;
  }
  const toml::table& root = file;
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

}  // namespace inkwell::window
