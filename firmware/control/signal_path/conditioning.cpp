#include "firmware/control/signal_path/conditioning.hpp"

#include "firmware/control/signal_path/trigonometry.hpp"

namespace inkwell::control {

namespace {

bool plausible(const Triple& offset_A) {
  for (const float each_A : offset_A)
    if (!(each_A > -CurrentOffsets::plausible_A && each_A < CurrentOffsets::plausible_A)) return false;
  return true;
}

}  // namespace

void measure_offsets(CurrentOffsets& offsets, const Triple& current_A) {
  constexpr float per_reading = 1.0f / static_cast<float>(CurrentOffsets::duration_periods);
  ++offsets.periods;
  for (std::size_t i = 0; i < 3; ++i) offsets.sum_A[i] += current_A[i];
  if (!offsets.measured()) return;
  for (std::size_t i = 0; i < 3; ++i) offsets.offset_A[i] = offsets.sum_A[i] * per_reading;
  offsets.plausible = plausible(offsets.offset_A);
}

void filter_supply(SupplyFilter& filter, float sample_V) {
  if (!filter.started || !is_finite(filter.supply_V)) filter.supply_V = sample_V;
  filter.started = true;
  filter.supply_V += SupplyFilter::weight * (sample_V - filter.supply_V);
  filter.per_V = reciprocal(filter.supply_V > SupplyFilter::floor_V ? filter.supply_V : SupplyFilter::floor_V);
}

void debounce(SwitchFilter& filter, std::uint8_t switches, std::size_t turn) {
  constexpr std::uint8_t settle_readings =
      (SwitchFilter::settle_periods + SwitchFilter::count - 1) / SwitchFilter::count;
  const unsigned changed = (unsigned{switches} ^ filter.closed) & 1u << turn;
  std::uint8_t& changed_readings = filter.changed_readings[turn];
  if (changed == 0) {
    changed_readings = 0;
  } else if (++changed_readings == settle_readings) {
    filter.closed = static_cast<std::uint8_t>(filter.closed ^ changed);
    changed_readings = 0;
  }
}

bool update_reference(InkwellReference& reference, const std::array<std::int32_t, 3>& encoder_counts,
                      bool inkwell_closed) {
  bool still = inkwell_closed;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::int32_t moved = encoder_counts[i] - reference.rest_counts[i];
    still = still && moved <= InkwellReference::still_counts && moved >= -InkwellReference::still_counts;
  }
  // The stylus must leave the inkwell before another reference is stored.
  const bool taken = inkwell_closed && reference.rested_periods > InkwellReference::still_periods;
  if (taken) return false;
  if (!still) {
    reference.rest_counts = encoder_counts;
    reference.rested_periods = 0;
    return false;
  }
  if (++reference.rested_periods <= InkwellReference::still_periods) return false;
  reference.counts = encoder_counts;
  reference.valid = true;
  return true;
}

}  // namespace inkwell::control
