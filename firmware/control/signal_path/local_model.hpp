// Local models approximate a large object near the tip. The PC computes them from a mesh at 1 kHz, and the board
// renders them at the servo rate (Adachi, Kumano, Ogino, "Intermediate representation for stiff virtual objects", VRAIS
// 1995).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "firmware/control/signal_path/solid.hpp"
#include "firmware/control/signal_path/surface.hpp"
#include "firmware/control/signal_path/trigonometry.hpp"
#include "protocol/reports.hpp"

namespace inkwell::control {

/// Largest rise of a recessed surface in a period, and the largest increase of its force.
inline constexpr float largest_rise_m = 5e-6f;
inline constexpr float largest_rise_N = 4e-3f;

/// A face, an edge or a corner of an object, as a surface that the center of the tip cannot pass. Positions are for the
/// age 0 of the model.
struct Feature {
  protocol::FeatureKind kind = protocol::FeatureKind::plane;
  Vector3 centre_m;  ///< a point of a plane, the center of a sphere, or a point on the axis of an infinite cylinder
  Vector3 axis;      ///< unit vector: the normal of a plane, the axis of a cylinder; zero for a sphere
  float radius_m = 0.0f;
  Vector3 axis_rate_per_s;  ///< change of `axis` by the rotation of the object
  Surface surface;
  Motion motion;  ///< the velocity is that of `centre_m`

  Plane tangent{.normal = {}, .offset_m = -1.0f};  ///< excludes no point until the feature has a tangent plane
  float tangent_speed_m_per_s = 0.0f;              ///< of the tangent plane along its normal
  /// The surface is this far below its final position. The surface moves outward slowly.
  float recess_m = 0.0f;
  float rise_limit_m = 0.0f;  ///< largest movement outward in a period
};

struct LocalModel {
  std::array<Feature, protocol::local_features_maximum> features{};
  std::size_t count = 0;
  std::uint32_t life_periods = 0;  ///< time until the model expires without a new model
  float age_s = 0.0f;
};

/// Sets the tangent plane at the foot of a point. In the core of a feature, the tangent plane does not change.
[[gnu::always_inline]] inline void renew_tangent(Feature& feature, const Vector3& point_m, float age_s) {
  const Vector3& velocity_m_per_s = feature.motion.velocity_m_per_s;
  const Vector3 axis = feature.axis + age_s * feature.axis_rate_per_s;
  Vector3 out_m = point_m - feature.centre_m - age_s * velocity_m_per_s;
  Vector3 normal = axis;
  float turn_m_per_s = 0.0f;  // inward speed at the foot because of the rotation
  if (feature.kind == protocol::FeatureKind::plane) [[unlikely]] {
    turn_m_per_s = dot(feature.axis_rate_per_s, out_m);
  } else {
    // The axis is longer than 1 after a rotation.
    const float along_m = (2.0f - dot(axis, axis)) * dot(axis, out_m);
    out_m = out_m - along_m * axis;
    const float squared_m2 = dot(out_m, out_m);
    if (!(squared_m2 > smallest_squared_m2)) return;
    normal = find_reciprocal_square_root(squared_m2) * out_m;
    turn_m_per_s = -along_m * dot(feature.axis_rate_per_s, normal);
  }
  feature.tangent_speed_m_per_s = dot(normal, velocity_m_per_s) - turn_m_per_s;
  feature.tangent = {normal, dot(normal, feature.centre_m) + feature.radius_m + age_s * turn_m_per_s};
}

/// Sets the tangent planes and the limits of the rises of a new model. This function is inline, because code of the
/// main loop must not be in the interrupt memory.
inline void find_tangents(LocalModel& model, const Vector3& proxy_m) {
  for (std::size_t i = 0; i < model.count; ++i) {
    Feature& feature = model.features[i];
    renew_tangent(feature, proxy_m, 0.0f);
    const float rise_m = largest_rise_N * feature.surface.m_per_N;
    feature.rise_limit_m = rise_m < largest_rise_m ? rise_m : largest_rise_m;
  }
}

}  // namespace inkwell::control
