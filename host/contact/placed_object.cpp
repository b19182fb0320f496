#include "host/contact/placed_object.hpp"

#include <glm/gtc/quaternion.hpp>

namespace inkwell::contact {

PlacedObject place(const Object& object, const Placement& placement) {
  PlacedObject placed;
  placed.object = &object;
  placed.surface = nullptr;
  placed.is_moving = false;
  placed.is_felt = true;
  placed.rotation = glm::mat3_cast(placement.rotation);
  placed.origin_m = placement.position_m;
  if (const auto* surface = std::get_if<std::shared_ptr<const geometry::Surface>>(&object.shape)) {
    placed.surface = surface->get();
    if (placed.surface)
      placed.origin_m += placed.rotation * placed.surface->middle_m();
    else
      placed.is_felt = false;
  }
  return placed;
}

}  // namespace inkwell::contact
