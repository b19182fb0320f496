// Local models approximate a large object near the tip. The PC computes them from a mesh at 1 kHz, and the board
// renders them at the servo rate (Adachi, Kumano, Ogino, "Intermediate representation for stiff virtual objects", VRAIS
// 1995).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "firmware/control/signal_path/solid.hpp"
#include "firmware/control/signal_path/surface.hpp"
#include "protocol/reports.hpp"

namespace inkwell::control {

/// A face, an edge or a corner of an object, as a surface that the center of the tip cannot pass. Positions are for the
/// age 0 of the model.
struct Feature {
  protocol::FeatureKind kind = protocol::FeatureKind::plane;
  Vector3 centre_m;  ///< a point of a plane, the center of a sphere, or a point on the axis of an infinite cylinder
  Vector3 axis;      ///< unit vector: the normal of a plane, the axis of a cylinder
  float radius_m = 0.0f;
  Vector3 axis_rate_per_s;  ///< change of `axis` by the rotation of the object
  Surface surface;
  Motion motion;  ///< the velocity is that of `centre_m`

  Plane tangent{.normal = {}, .offset_m = -1.0f};  ///< excludes no point until the feature has a tangent plane
  float tangent_speed_m_per_s = 0.0f;              ///< of the tangent plane along its normal
  /// The surface is this far below its final position. The surface moves outward slowly.
  float recess_m = 0.0f;
};

struct LocalModel {
  /// Largest speed at which a surface under the tip moves to its final position.
  static constexpr float recovery_m_per_s = 0.1f;

  std::array<Feature, protocol::local_features_maximum> features{};
  std::size_t count = 0;
  std::uint32_t life_periods = 0;  ///< time until the model expires without a new model
  float age_s = 0.0f;
  std::size_t turn = 0;  ///< number of the feature whose tangent plane is the next to be renewed
};

/// Sets the tangent plane at the foot of a point. In the core of a feature, the tangent plane does not change.
void renew_tangent(Feature& feature, const Vector3& point_m, float age_s);

/// Sets the tangent planes of a new model. This function is inline, because code of the main loop must not be in the
/// interrupt memory.
inline void find_tangents(LocalModel& model, const Vector3& proxy_m) {
  for (std::size_t i = 0; i < model.count; ++i) renew_tangent(model.features[i], proxy_m, 0.0f);
}

}  // namespace inkwell::control
