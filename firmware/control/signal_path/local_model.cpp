#include "firmware/control/signal_path/local_model.hpp"

#include "firmware/control/signal_path/trigonometry.hpp"

namespace inkwell::control {

void renew_tangent(Feature& feature, const Vector3& point_m, float age_s) {
  const Vector3& velocity_m_per_s = feature.motion.velocity_m_per_s;
  const Vector3 axis = feature.axis + age_s * feature.axis_rate_per_s;
  Vector3 out_m = point_m - feature.centre_m - age_s * velocity_m_per_s;
  Vector3 normal = axis;
  float height_m = 0.0f, speed_m_per_s = 0.0f;
  if (feature.kind == protocol::FeatureKind::plane) {
    height_m = dot(axis, out_m);
    speed_m_per_s = dot(axis, velocity_m_per_s) - dot(feature.axis_rate_per_s, out_m);
  } else {
    float along_m = 0.0f;
    if (feature.kind == protocol::FeatureKind::cylinder) {
      along_m = dot(axis, out_m);
      out_m = out_m - along_m * axis;
    }
    const float squared_m2 = dot(out_m, out_m);
    if (!(squared_m2 > smallest_squared_m2)) return;
    const float per_distance = reciprocal_square_root(squared_m2);
    normal = per_distance * out_m;
    height_m = squared_m2 * per_distance - feature.radius_m;
    speed_m_per_s = dot(normal, velocity_m_per_s + along_m * feature.axis_rate_per_s);
  }
  feature.tangent = {normal, dot(normal, point_m) - height_m - age_s * speed_m_per_s};
  feature.tangent_speed_m_per_s = speed_m_per_s;
}

}  // namespace inkwell::control
