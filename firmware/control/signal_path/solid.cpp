#include "firmware/control/signal_path/solid.hpp"

#include "firmware/control/signal_path/trigonometry.hpp"

namespace inkwell::control {

bool find_foot(const Solid& solid, const Vector3& point_m, Foot& foot) {
  Vector3 out_m = point_m - solid.centre_m;
  const std::size_t axes = solid.core == Solid::Core::point ? 0 : (solid.core == Solid::Core::box ? 3 : 1);
#pragma GCC unroll 1  // unrolled code does not fit into the interrupt memory
  for (std::size_t i = 0; i < axes; ++i) {
    const Vector3& axis = solid.axes[i];
    out_m = out_m - clamp(dot(axis, out_m), -solid.half_m[i], solid.half_m[i]) * axis;
  }
  if (solid.core == Solid::Core::cylinder) {
    const Vector3 along_m = dot(solid.axes[0], out_m) * solid.axes[0];
    const Vector3 radial_m = out_m - along_m;
    const float squared_m2 = dot(radial_m, radial_m);
    const bool is_beside = squared_m2 > solid.core_radius_m * solid.core_radius_m && squared_m2 > smallest_squared_m2;
    out_m = is_beside ? out_m - (solid.core_radius_m * reciprocal_square_root(squared_m2)) * radial_m : along_m;
  }
  const float squared_m2 = dot(out_m, out_m);
  if (!(squared_m2 > smallest_squared_m2)) return false;
  const float per_distance = reciprocal_square_root(squared_m2);
  foot = {per_distance * out_m, squared_m2 * per_distance - solid.radius_m};
  return true;
}

bool find_tangent(const Solid& solid, const Vector3& point_m, float margin_m, Plane& tangent) {
  Foot foot;
  if (!find_foot(solid, point_m, foot)) return false;
  tangent = {foot.normal, dot(foot.normal, point_m) - foot.height_m};
  return foot.height_m < margin_m;
}

}  // namespace inkwell::control
