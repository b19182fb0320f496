#include "firmware/control/signal_path/shapes.hpp"

namespace inkwell::control {

namespace {

/// Plane for an unused entry. Every point is in the free space of this plane.
constexpr Plane nowhere{.normal = {}, .offset_m = -1.0f};

}  // namespace

void LivingShapes::replace(const Shapes& shapes) {
  shapes_ = &shapes;
  age_periods_ = 0;
  list_alive();
}

bool LivingShapes::age() {
  if (next_end_periods_ == 0 || ++age_periods_ != next_end_periods_) return false;
  list_alive();
  return true;
}

void LivingShapes::list_alive() {
  next_end_periods_ = 0;
  alive_ = 0;
  for (std::size_t i = 0; i < Shapes::maximum; ++i) {
    const std::uint32_t end_periods = shapes_->life_periods[i];
    const bool lives = end_periods > age_periods_;
    const bool ends_next = next_end_periods_ == 0 || end_periods < next_end_periods_;
    if (lives) alive_ |= 1u << i;
    if (lives && end_periods != Shapes::lasting && ends_next) next_end_periods_ = end_periods;
    if (i < planes_.size()) planes_[i] = lives ? shapes_->planes[i] : nowhere;
  }
}

}  // namespace inkwell::control
