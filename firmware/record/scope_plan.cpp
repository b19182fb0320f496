#include "firmware/record/scope_plan.hpp"

namespace inkwell::link {

namespace {

/// Signal table columns for recording. The image does not contain the texts of the signal table.
constexpr std::array<protocol::SignalWire, protocol::signal_count> wires = []() {
  std::array<protocol::SignalWire, protocol::signal_count> rows{};
  for (std::size_t i = 0; i < rows.size(); ++i) rows[i] = protocol::signal_table[i].wire;
  return rows;
}();

/// Signals of a force law are floats.
protocol::SignalWire wire_of(std::uint8_t signal) {
  return signal < wires.size() ? wires[signal] : protocol::SignalWire::float32;
}

constexpr float steps_per_unit(protocol::SignalWire wire) {
  switch (wire) {
    case protocol::SignalWire::current_int16: return 1.0f / protocol::current_step_A;
    case protocol::SignalWire::duty_int16: return 1.0f / protocol::duty_step;
    case protocol::SignalWire::float32: break;
  }
  return 0.0f;
}

}  // namespace

ScopePlan prepare(const protocol::SignalSelection& selection, std::uint8_t token) {
  ScopePlan plan;
  plan.count = selection.count;
  plan.token = token;
  std::uint32_t size = 0;
  std::size_t run = 0;
  for (std::size_t i = 0; i < selection.count; ++i) {
    const protocol::SignalWire wire = wire_of(selection.signals[i]);
    plan.items[i] = selection.signals[i];
    plan.steps_per_unit[i] = steps_per_unit(wire);
    const bool narrow = wire != protocol::SignalWire::float32;
    const bool run_is_narrow = run % 2 != 0;
    if (narrow != run_is_narrow) ++run;
    plan.run_ends[run] = static_cast<std::uint8_t>(i + 1);
    size += static_cast<std::uint32_t>(protocol::wire_size(wire));
  }
  // protocol::encoding_for() has the same rule, but needs the signal table.
  const bool full = size <= protocol::scope_full_sample_maximum;
  plan.encoding = full ? protocol::ScopeEncoding::full : protocol::ScopeEncoding::changes;
  plan.sample_size_maximum = full ? size : size + static_cast<std::uint32_t>(sizeof(std::uint32_t));
  return plan;
}

}  // namespace inkwell::link
