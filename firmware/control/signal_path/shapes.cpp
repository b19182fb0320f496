#include "firmware/control/signal_path/shapes.hpp"

#include <bit>

namespace inkwell::control {

void LivingShapes::replace(Shapes& shapes) {
  shapes_ = &shapes;
  age_periods_ = 0;
  living_ = shapes.used;
  near_ = shapes.near;
}

bool LivingShapes::age() {
  if (living_ == 0) return false;
  ++age_periods_;
  aged_ = aged_ == 0 ? Shapes::maximum - 1 : aged_ - 1;
  const std::uint32_t bit = 1u << aged_;
  const std::uint32_t life_periods = shapes_->life_periods[aged_];
  if ((living_ & bit) == 0 || life_periods > age_periods_ || life_periods == Shapes::lasting) return false;
  living_ &= ~bit;
  near_ &= ~bit;
  return true;
}

void LivingShapes::examine(const Vector3& proxy_m, float margin_m) {
  is_turn_of_near_solids_ = !is_turn_of_near_solids_;
  if (is_turn_of_near_solids_)
    examine_next(above_solid_, near_ & ~Shapes::all_planes, proxy_m, margin_m);
  else
    examine_next(above_, living_ & (Shapes::all_planes | ~near_), proxy_m, margin_m);
}

bool LivingShapes::renew(std::size_t number, const Vector3& proxy_m, float margin_m) {
  const std::uint32_t bit = 1u << number;
  near_ &= ~bit;
  if (!renew_tangent(*shapes_, number, proxy_m, margin_m)) return false;
  near_ |= bit;
  return true;
}

void LivingShapes::examine_next(std::uint32_t& above, std::uint32_t among, const Vector3& proxy_m, float margin_m) {
  if (among == 0) return;
  const std::uint32_t later = among & above;
  const auto number = static_cast<std::size_t>(std::countr_zero(later != 0 ? later : among));
  above = ~1u << number;
  renew(number, proxy_m, margin_m);
}

}  // namespace inkwell::control
