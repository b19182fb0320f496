#include "host/contact/scene.hpp"

#include <algorithm>

#include <glm/geometric.hpp>

namespace inkwell::contact {

Placement placement_after(const Object& object, double time_s) {
  if (!object.moves()) return object.placement;
  const double moving_s = std::clamp(time_s, 0.0, motion_max_s);
  Placement placement = object.placement;
  placement.position_m += object.velocity_m_per_s * moving_s;
  const double spin_rad_per_s = glm::length(object.spin_rad_per_s);
  if (spin_rad_per_s > 0) {
    const glm::dquat turn = glm::angleAxis(spin_rad_per_s * moving_s, object.spin_rad_per_s / spin_rad_per_s);
    placement.rotation = glm::normalize(turn * placement.rotation);
  }
  return placement;
}

}  // namespace inkwell::contact
