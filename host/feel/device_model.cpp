#include "host/feel/device_model.hpp"

namespace inkwell::feel {
namespace {

static_assert(contact::features_max == protocol::local_features_maximum);
static_assert(contact::materials_max == protocol::materials_maximum);
static_assert(contact::tip_radius_min_m == 0.0005 && protocol::local_tip_radius_minimum_m == 0.0005f);

std::array<float, 3> array_of(const glm::vec3& vector) { return {vector.x, vector.y, vector.z}; }

protocol::FeatureKind kind_of(contact::Feature::Kind kind) {
  switch (kind) {
    case contact::Feature::Kind::plane: return protocol::FeatureKind::plane;
    case contact::Feature::Kind::cylinder: return protocol::FeatureKind::cylinder;
    case contact::Feature::Kind::sphere: return protocol::FeatureKind::sphere;
  }
  return protocol::FeatureKind::plane;
}

}  // namespace

device::LocalModel device_model(const contact::LocalModel& model) {
  device::LocalModel converted;
  converted.count = model.count;
  for (std::size_t number = 0; number < model.count; ++number) {
    const contact::Feature& feature = model.features[number];
    converted.features[number] = {kind_of(feature.kind),     array_of(feature.direction),
                                  array_of(feature.point_m), feature.radius_m,
                                  feature.material,          feature.moves};
  }
  converted.anchor_m = array_of(model.anchor_m);
  converted.velocity_m_per_s = array_of(model.velocity_m_per_s);
  converted.spin_rad_per_s = array_of(model.spin_rad_per_s);
  return converted;
}

std::vector<device::Material> device_materials(const contact::Scene& scene) {
  std::vector<device::Material> converted;
  for (const contact::Material& material : scene.materials)
    converted.push_back({material.stiffness_N_per_m, material.damping_Ns_per_m, material.static_friction,
                         material.dynamic_friction, material.viscosity_Ns_per_m});
  return converted;
}

}  // namespace inkwell::feel
