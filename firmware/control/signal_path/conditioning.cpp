#include "firmware/control/signal_path/conditioning.hpp"

#include "firmware/control/signal_path/trigonometry.hpp"

namespace inkwell::control {

namespace {

bool is_plausible(const Triple& offset_A) {
  for (const float each_A : offset_A)
    if (!(each_A > -CurrentOffsets::plausible_A && each_A < CurrentOffsets::plausible_A)) return false;
  return true;
}

}  // namespace

void CurrentOffsets::measure(const Triple& current_A) {
  constexpr float per_reading = 1.0f / static_cast<float>(duration_periods);
  ++periods;
  for (std::size_t i = 0; i < 3; ++i) sum_A[i] += current_A[i];
  if (!measured()) return;
  for (std::size_t i = 0; i < 3; ++i) offset_A[i] = sum_A[i] * per_reading;
  plausible = is_plausible(offset_A);
}

void SupplyFilter::add_sample(float sample_V) {
  if (!started || !is_finite(supply_V)) supply_V = sample_V;
  started = true;
  supply_V += weight * (sample_V - supply_V);
  per_V = reciprocal(supply_V > floor_V ? supply_V : floor_V);
}

void SwitchFilter::debounce(std::uint8_t switches, std::size_t turn) {
  constexpr std::uint8_t settle_readings = (settle_periods + count - 1) / count;
  const unsigned changed = (unsigned{switches} ^ closed) & 1u << turn;
  std::uint8_t& readings = changed_readings[turn];
  if (changed == 0) {
    readings = 0;
  } else if (++readings == settle_readings) {
    closed = static_cast<std::uint8_t>(closed ^ changed);
    readings = 0;
  }
}

bool InkwellReference::update(const std::array<std::int32_t, 3>& encoder_counts, bool inkwell_closed) {
  bool still = inkwell_closed;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::int32_t moved = encoder_counts[i] - rest_counts[i];
    still = still && moved <= still_counts && moved >= -still_counts;
  }
  // The stylus must leave the inkwell before another reference is stored.
  const bool taken = inkwell_closed && rested_periods > still_periods;
  if (taken) return false;
  if (!still) {
    rest_counts = encoder_counts;
    rested_periods = 0;
    return false;
  }
  if (++rested_periods <= still_periods) return false;
  counts = encoder_counts;
  valid = true;
  return true;
}

}  // namespace inkwell::control
