#include "firmware/record/scope_plan.hpp"

#include <algorithm>
#include <span>

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

/// Returns the size of the values in bytes.
std::uint32_t fill(ScopeGroup& group, std::span<const std::uint8_t> items) {
  std::uint32_t size = 0;
  std::size_t run = 0;
  for (const std::uint8_t item : items) {
    const protocol::SignalWire wire = wire_of(item);
    const std::uint32_t i = group.count++;
    group.items[i] = item;
    group.steps_per_unit[i] = steps_per_unit(wire);
    const bool narrow = wire != protocol::SignalWire::float32;
    const bool run_is_narrow = run % 2 != 0;
    if (narrow != run_is_narrow) ++run;
    group.run_ends[run] = static_cast<std::uint8_t>(i + 1);
    size += static_cast<std::uint32_t>(protocol::wire_size(wire));
  }
  return size;
}

}  // namespace

ScopePlan prepare(const protocol::SignalSelection& selection, std::uint8_t token) {
  const protocol::SelectedSignals selected = protocol::selected_signals(selection);
  ScopePlan plan;
  plan.token = token;
  const std::size_t fast_count = std::min(selected.count, protocol::scope_signals_maximum);
  std::uint32_t size = fill(plan.fast, std::span(selected.items).first(fast_count));
  size += fill(plan.slow, std::span(selected.items).subspan(fast_count, selected.count - fast_count));
  // protocol::encoding_for() has the same rule, but needs the signal table.
  const bool full = size <= protocol::scope_full_sample_maximum;
  plan.encoding = full ? protocol::ScopeEncoding::full : protocol::ScopeEncoding::changes;
  const std::uint32_t masks = full ? 0 : plan.slow.count == 0 ? 1 : 2;
  plan.sample_size_maximum = size + masks * static_cast<std::uint32_t>(sizeof(std::uint32_t));
  return plan;
}

}  // namespace inkwell::link
