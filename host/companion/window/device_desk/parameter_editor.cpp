#include "host/companion/window/device_desk/parameter_editor.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <utility>

namespace inkwell::window {

using device::ParameterChange;
using protocol::Parameter;

namespace {

constexpr double confirmation_time_s = 1.0;
constexpr std::size_t steps_maximum = 200;

std::size_t index_of(Parameter parameter) { return static_cast<std::size_t>(parameter); }

void put(std::vector<ParameterChange>& changes, Parameter parameter, float value) {
  const auto found = std::ranges::find(changes, parameter, &ParameterChange::first);
  if (found == changes.end()) {
    changes.emplace_back(parameter, value);
  } else {
    found->second = value;
  }
}

}  // namespace

void ParameterEditor::device_holds(const protocol::ParameterSet& held) {
  held_ = held;
  bool all_confirmed = true;
  for (std::size_t i = 0; i < protocol::known_parameters().size(); ++i) {
    if (!wanted_[i]) continue;
    if (wanted_[i]->value == held.values[i]) {
      wanted_[i].reset();
    } else {
      all_confirmed = false;
    }
  }
  if (all_confirmed && outgoing_.empty())
    for (std::size_t i = 0; i < position_; ++i) steps_[i].confirmed = true;
}

void ParameterEditor::refused() {
  wanted_.fill(std::nullopt);
  outgoing_.clear();
  if (position_ > 0 && !steps_[position_ - 1].confirmed) {
    --position_;
    steps_.erase(steps_.begin() + static_cast<std::ptrdiff_t>(position_), steps_.end());
  }
}

void ParameterEditor::disconnected() {
  held_.reset();
  wanted_.fill(std::nullopt);
  outgoing_.clear();
  open_step_.reset();
}

void ParameterEditor::forget_unconfirmed(double now_s) {
  if (open_step_) return;
  for (auto& wanted : wanted_)
    if (wanted && now_s - wanted->since_s > confirmation_time_s) wanted.reset();
}

float ParameterEditor::shown(Parameter parameter) const {
  const std::size_t i = index_of(parameter);
  if (wanted_[i]) return wanted_[i]->value;
  return held_ ? held_->values[i] : protocol::info(parameter).default_value;
}

protocol::ParameterSet ParameterEditor::shown() const {
  protocol::ParameterSet set{};
  for (std::size_t i = 0; i < protocol::known_parameters().size(); ++i)
    set.values[i] = shown(static_cast<Parameter>(i));
  return set;
}

bool ParameterEditor::differs_from_default(Parameter parameter) const {
  return shown(parameter) != protocol::info(parameter).default_value;
}

void ParameterEditor::want(Parameter parameter, float value, double now_s) {
  wanted_[index_of(parameter)] = Wanted{value, now_s};
  put(outgoing_, parameter, value);
}

void ParameterEditor::begin_step(std::string title) {
  end_step();
  open_step_ = Step{std::move(title), {}, false};
}

void ParameterEditor::edit(std::span<const ParameterChange> changes, double now_s) {
  if (!open_step_ || !known()) return;
  for (const auto& [parameter, value] : changes) {
    const float before = shown(parameter);
    if (before == value) continue;
    const auto found = std::ranges::find(open_step_->differences, parameter, &Difference::parameter);
    if (found == open_step_->differences.end()) {
      open_step_->differences.push_back({parameter, before, value});
    } else {
      found->after = value;
    }
    want(parameter, value, now_s);
  }
}

void ParameterEditor::end_step() {
  if (!open_step_) return;
  Step step = std::move(*open_step_);
  open_step_.reset();
  std::erase_if(step.differences, [](const Difference& each) { return each.before == each.after; });
  if (step.differences.empty()) return;
  steps_.erase(steps_.begin() + static_cast<std::ptrdiff_t>(position_), steps_.end());
  if (steps_.size() == steps_maximum) steps_.erase(steps_.begin());
  steps_.push_back(std::move(step));
  position_ = steps_.size();
}

void ParameterEditor::apply(std::string title, std::span<const ParameterChange> changes, double now_s) {
  begin_step(std::move(title));
  edit(changes, now_s);
  end_step();
}

void ParameterEditor::undo(double now_s) {
  if (!can_undo() || !known()) return;
  --position_;
  for (const auto& each : steps_[position_].differences) want(each.parameter, each.before, now_s);
}

void ParameterEditor::redo(double now_s) {
  if (!can_redo() || !known()) return;
  for (const auto& each : steps_[position_].differences) want(each.parameter, each.after, now_s);
  ++position_;
}

std::vector<ParameterChange> ParameterEditor::take_changes() { return std::exchange(outgoing_, {}); }

namespace {

/// Converts a unit to the suffix of a parameter name: "V/(As)" to "_V_per_As".
std::string name_ending(std::string_view unit) {
  std::string ending = unit.empty() ? "" : "_";
  for (const char character : unit) {
    if (character == '/')
      ending += "_per_";
    else if (character != '(' && character != ')')
      ending += character;
  }
  return ending;
}

}  // namespace

std::string label_of(const protocol::ParameterInfo& info) {
  std::string_view name = info.name;
  if (const std::string ending = name_ending(info.unit); name.ends_with(ending)) name.remove_suffix(ending.size());
  // In the group "Box", the label of "box_minimum_x" is "Minimum x".
  const std::string_view first_word = info.group.substr(0, info.group.find(' '));
  if (name.starts_with(first_word) && name.size() > first_word.size() + 1 && name[first_word.size()] == '_' &&
      std::isalpha(static_cast<unsigned char>(name[first_word.size() + 1])) != 0)
    name.remove_prefix(first_word.size() + 1);
  std::string label{name};
  std::ranges::replace(label, '_', ' ');
  label[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(label[0])));
  return label;
}

std::string full_label_of(protocol::ParameterInfo info) {
  info.group = {};
  return label_of(info);
}

int decimals_of(const protocol::ParameterInfo& info) {
  if (info.kind != protocol::ParameterKind::real) return 0;
  const float resolution = std::max(info.maximum - info.minimum, 1e-6f) / 10'000.0f;
  return std::clamp(static_cast<int>(std::ceil(-std::log10(resolution))), 0, 5);
}

std::span<const Preset> presets() {
  using enum Parameter;
  static const std::array<Preset, 3> all{{
      {"Soft",
       "A wall like rubber: 250 N/m with little damping.",
       {{wall_stiffness_N_per_m, 250.0f}, {wall_damping_Ns_per_m, 0.5f}}},
      {"Stiff",
       "A wall like wood: 1500 N/m with enough damping to prevent vibration.",
       {{wall_stiffness_N_per_m, 1500.0f}, {wall_damping_Ns_per_m, 3.0f}}},
      {"Viscous",
       "A wall like honey: 120 N/m with a damping of 10 Ns/m.",
       {{wall_stiffness_N_per_m, 120.0f}, {wall_damping_Ns_per_m, 10.0f}}},
  }};
  return all;
}

}  // namespace inkwell::window
