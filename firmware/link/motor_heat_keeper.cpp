#include <link/motor_heat_keeper.hpp>

#include <algorithm>

#include <link/guarded.hpp>

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

bool MotorHeatKeeper::is_sound(const Place& place) {
  return place.check == ~sum_of(place.left) && is_plausible(place.left.warmth.heat) &&
         is_plausible(place.left.warmth.housing);
}

std::optional<control::Warmth> MotorHeatKeeper::start(bool power_has_come) {
  const Place* newest = nullptr;
  for (Place& place : places_) {
    if (power_has_come) place.check = sum_of(place.left);  // invalidates the slot for later starts
    if (is_sound(place) && (newest == nullptr || place.left.number - newest->left.number < 0x8000'0000))
      newest = &place;
  }
  next_number_ = newest != nullptr ? newest->left.number + 1 : 0;
  return newest != nullptr ? std::optional(newest->left.warmth) : std::nullopt;
}

void MotorHeatKeeper::leave(const control::Warmth& warmth) {
  Place& place = places_[next_number_ % 2];
  place.left = {{within_range(warmth.heat), within_range(warmth.housing), warmth.too_hot}, next_number_++};
  place.check = ~sum_of(place.left);
}

}  // namespace inkwell::link
