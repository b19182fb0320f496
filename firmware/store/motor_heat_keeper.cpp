#include "firmware/store/motor_heat_keeper.hpp"

#include <algorithm>

#include "firmware/exchange/guarded.hpp"

namespace inkwell::link {
namespace {

/// Returns false for NaN.
bool is_plausible(const control::Triple& heat) {
  return std::ranges::all_of(heat, [](float value) { return value >= 0.0f && value <= MotorHeatKeeper::most; });
}

/// Replaces NaN by the maximum.
control::Triple within_range(control::Triple heat) {
  for (float& value : heat) value = value < MotorHeatKeeper::most ? std::max(value, 0.0f) : MotorHeatKeeper::most;
  return heat;
}

}  // namespace

bool MotorHeatKeeper::is_valid(const Slot& slot) {
  return slot.check == ~sum_of(slot.record) && is_plausible(slot.record.warmth.heat) &&
         is_plausible(slot.record.warmth.housing);
}

std::optional<control::Warmth> MotorHeatKeeper::start(bool after_power_on) {
  const Slot* newest = nullptr;
  for (Slot& slot : slots_) {
    if (after_power_on) slot.check = sum_of(slot.record);  // invalidates the slot for later starts
    if (is_valid(slot) && (newest == nullptr || slot.record.number - newest->record.number < 0x8000'0000))
      newest = &slot;
  }
  next_number_ = newest != nullptr ? newest->record.number + 1 : 0;
  return newest != nullptr ? std::optional(newest->record.warmth) : std::nullopt;
}

void MotorHeatKeeper::store(const control::Warmth& warmth) {
  Slot& slot = slots_[next_number_ % 2];
  slot.record = {{within_range(warmth.heat), within_range(warmth.housing), warmth.too_hot}, next_number_++};
  slot.check = ~sum_of(slot.record);
}

}  // namespace inkwell::link
