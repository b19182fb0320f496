#include "host/companion/window/scope/scope_signal.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <numeric>
#include <string>

namespace inkwell::window {

using protocol::Signal;

namespace {

/// First signal of a group. The group extends to the first signal of the next group.
struct GroupBegin {
  Signal first;
  std::string_view title;
};
constexpr auto group_begins = std::to_array<GroupBegin>({{Signal::encoder_1_counts, "Encoders and joints"},
                                                         {Signal::position_x_m, "Probe"},
                                                         {Signal::penetration_x_m, "Contact"},
                                                         {Signal::torque_1_Nm, "Torques"},
                                                         {Signal::current_reference_1_A, "Currents and duty"},
                                                         {Signal::gimbal_1_rad, "Gimbal"},
                                                         {Signal::joint_speed_1_rad_s, "Joint speeds"},
                                                         {Signal::supply_V, "Supply"},
                                                         {Signal::servo_cycles, "Control interrupt"},
                                                         {Signal::motor_heat_1, "Motor heat"},
                                                         {Signal::program_force_x_N, "Programs and limits"}});
static_assert(group_begins.front().first == Signal{});
static_assert(std::ranges::is_sorted(group_begins, {}, &GroupBegin::first));

std::string_view group_of(Signal signal) {
  if (static_cast<std::size_t>(signal) >= protocol::signal_count) return "Force law";
  const auto next_group = std::ranges::upper_bound(group_begins, signal, {}, &GroupBegin::first);
  return std::prev(next_group)->title;
}

std::string in_small_letters(std::string_view text) {
  std::string small(text);
  std::ranges::transform(small, small.begin(), [](unsigned char letter) { return std::tolower(letter); });
  return small;
}

bool has_each_word(std::string_view text, std::string_view words) {
  while (true) {
    words.remove_prefix(std::min(words.find_first_not_of(' '), words.size()));
    if (words.empty()) return true;
    const std::string_view word = words.substr(0, words.find(' '));
    if (text.find(word) == std::string_view::npos) return false;
    words.remove_prefix(word.size());
  }
}

}  // namespace

std::string_view ScopeSignal::unit() const {
  if (!formula_) return info(signal_).unit;
  return formula_->unit == "1" ? std::string_view{} : std::string_view(formula_->unit);
}

std::vector<Signal> ScopeSignal::inputs() const {
  return formula_ ? inputs_of(formula_->text) : std::vector<Signal>{signal_};
}

bool ScopeSignal::operator==(const ScopeSignal& other) const {
  if (!formula_ || !other.formula_) return !formula_ && !other.formula_ && signal_ == other.signal_;
  return formula_ == other.formula_ || *formula_ == *other.formula_;
}

bool is_reference(const ScopeSignal& signal) { return signal.name().find("_reference") != std::string_view::npos; }

std::vector<std::size_t> drawing_order(const std::vector<ScopeSignal>& signals) {
  std::vector<std::size_t> order(signals.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_partition(order.begin(), order.end(), [&](std::size_t i) { return !is_reference(signals[i]); });
  return order;
}

std::vector<SignalGroup> signal_groups(std::string_view search) {
  const std::string words = in_small_letters(search);
  std::vector<SignalGroup> groups;
  for (const protocol::SignalInfo& row : protocol::known_signals()) {
    const auto signal = static_cast<Signal>(row.id);
    const std::string_view title = group_of(signal);
    const std::string all = in_small_letters(std::string(row.name) + " " + std::string(row.help) + " " +
                                             std::string(title) + " " + std::string(row.unit));
    if (!has_each_word(all, words)) continue;
    if (groups.empty() || groups.back().title != title) groups.push_back({title, {}});
    groups.back().signals.push_back(signal);
  }
  return groups;
}

}  // namespace inkwell::window
