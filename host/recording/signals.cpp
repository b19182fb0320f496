#include <recording/signals.hpp>

#include <algorithm>

#include <fmt/format.h>

#include <device/error.hpp>
#include <device/nearest_name.hpp>
#include <protocol/reports.hpp>

namespace inkwell::recording {
namespace {

using protocol::Signal;

void append_range(std::vector<Signal>& signals, Signal first, Signal last) {
  for (auto i = static_cast<int>(first); i <= static_cast<int>(last); ++i) signals.push_back(static_cast<Signal>(i));
}

void remove_suffix(std::string& text, std::string_view suffix) {
  if (!suffix.empty() && text.ends_with(suffix)) text.resize(text.size() - suffix.size());
}

}  // namespace

std::vector<Signal> standard_signals() {
  std::vector<Signal> signals;
  append_range(signals, Signal::joint_1_rad, Signal::position_z_m);
  append_range(signals, Signal::penetration_x_m, Signal::torque_3_Nm);
  append_range(signals, Signal::current_1_A, Signal::gimbal_3_rad);
  return signals;
}

std::vector<Signal> signal_path() {
  std::vector<Signal> signals;
  append_range(signals, Signal::encoder_1_counts, Signal::duty_3);
  return signals;
}

std::vector<Signal> parse_signals(std::string_view names) {
  std::vector<Signal> signals;
  while (!names.empty()) {
    const auto name = names.substr(0, names.find(','));
    names.remove_prefix(std::min(names.size(), name.size() + 1));
    const auto signal = protocol::find_signal(name);
    if (!signal)
      throw device::Error(fmt::format("There is no signal `{}`. Did you mean {}?", name,
                                      device::nearest_name(protocol::signal_table, name)));
    if (std::find(signals.begin(), signals.end(), *signal) == signals.end()) signals.push_back(*signal);
  }
  if (signals.empty()) throw device::Error("No signal is named. Name at least one, such as force_N.");
  if (signals.size() > protocol::scope_signals_maximum)
    throw device::Error(fmt::format("{} signals are named, but the scope carries {} at once. Leave some out.",
                                    signals.size(), protocol::scope_signals_maximum));
  return signals;
}

std::string quantity_of(Signal signal) {
  const auto& row = protocol::info(signal);
  std::string name(row.name), unit(row.unit);
  std::replace(unit.begin(), unit.end(), '/', '_');
  if (!unit.empty()) remove_suffix(name, "_" + unit);
  for (const char* part : {"_x", "_y", "_z", "_1", "_2", "_3"}) remove_suffix(name, part);
  std::replace(name.begin(), name.end(), '_', ' ');
  return name;
}

}  // namespace inkwell::recording
