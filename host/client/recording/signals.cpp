#include "host/client/recording/signals.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "host/client/device/error.hpp"
#include "host/client/device/nearest_name.hpp"

namespace inkwell::recording {
namespace {

using protocol::Signal;

void append_range(std::vector<Signal>& signals, Signal first, Signal last) {
  for (auto i = static_cast<int>(first); i <= static_cast<int>(last); ++i) signals.push_back(static_cast<Signal>(i));
}

std::vector<std::string_view> split(std::string_view names) {
  std::vector<std::string_view> parts;
  while (!names.empty()) {
    parts.push_back(names.substr(0, names.find(',')));
    names.remove_prefix(std::min(names.size(), parts.back().size() + 1));
  }
  if (parts.empty()) throw device::Error("No signal is given. Give at least one signal, such as force_N.");
  return parts;
}

template <class Value>
void add_once(std::vector<Value>& values, Value value) {
  if (std::find(values.begin(), values.end(), value) == values.end()) values.push_back(value);
}

}  // namespace

std::vector<Signal> standard_signals() {
  std::vector<Signal> signals;
  append_range(signals, Signal::joint_1_rad, Signal::position_z_m);
  append_range(signals, Signal::penetration_x_m, Signal::torque_3_Nm);
  append_range(signals, Signal::current_1_A, Signal::gimbal_3_rad);
  signals.push_back(Signal::force_sources);
  signals.push_back(Signal::limits);
  return signals;
}

std::vector<Signal> signal_path() {
  std::vector<Signal> signals;
  append_range(signals, Signal::encoder_1_counts, Signal::duty_3);
  return signals;
}

std::vector<Signal> all_signals() {
  std::vector<Signal> signals;
  for (const auto& row : protocol::known_signals()) signals.push_back(static_cast<Signal>(row.id));
  return signals;
}

std::vector<Signal> parse_signals(std::string_view names) {
  std::vector<Signal> signals;
  for (const auto name : split(names)) {
    const auto signal = protocol::find_signal(name);
    if (!signal)
      throw device::UnknownName(fmt::format("There is no signal `{}`.{} `inkwell signals` lists them all.", name,
                                            device::suggestion(protocol::known_signals(), name)));
    add_once(signals, *signal);
  }
  return signals;
}

std::vector<Quantity> parse_quantities(std::string_view names) {
  struct Named {
    std::string_view name;
  };
  std::vector<Named> known;
  for (const auto& row : protocol::known_signals()) known.push_back({row.name});
  for (const auto& row : protocol::simulated_quantity_table) known.push_back({row.name});
  std::vector<Quantity> quantities;
  for (const auto name : split(names)) {
    if (const auto signal = protocol::find_signal(name))
      add_once(quantities, Quantity(*signal));
    else if (const auto simulated = protocol::find_simulated_quantity(name))
      add_once(quantities, Quantity(*simulated));
    else
      throw device::Error(fmt::format("There is no signal `{}`.{} `inkwell signals` lists them all.", name,
                                      device::suggestion(known, name)));
  }
  return quantities;
}

}  // namespace inkwell::recording
