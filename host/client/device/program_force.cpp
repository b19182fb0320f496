#include "host/client/device/program_force.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <string>

#include <fmt/format.h>

#include "host/client/device/error.hpp"
#include "protocol/directions.hpp"

namespace inkwell::device {
namespace {

using protocol::Parameter;

void require_in_range(const std::string& what, float value, float minimum, float maximum, const char* unit) {
  if (value >= minimum && value <= maximum) return;
  throw Error(fmt::format("{} is {}{}. Give a number from {} to {}{}.", what, value, unit, minimum, maximum, unit));
}

void require_coordinates(const std::string& what, const std::array<float, 3>& coordinates_m) {
  for (const float coordinate_m : coordinates_m)
    require_in_range(what, coordinate_m, -protocol::shape_distance_maximum_m, protocol::shape_distance_maximum_m, " m");
}

void copy(const std::array<float, 3>& from, float (&to)[3]) { std::memcpy(to, from.data(), sizeof to); }

void require_properties(const std::string& shape, const Material& surface) {
  const auto& stiffness = info(Parameter::wall_stiffness_N_per_m);
  const auto& damping = info(Parameter::wall_damping_Ns_per_m);
  if (!(surface.stiffness_N_per_m > 0.0f) || surface.stiffness_N_per_m > stiffness.maximum)
    throw Error(fmt::format("The stiffness of {} is {} N/m. Give a number above 0, at most {} N/m.", shape,
                            surface.stiffness_N_per_m, stiffness.maximum));
  require_in_range("The damping of " + shape, surface.damping_Ns_per_m, 0.0f, damping.maximum, " Ns/m");
  require_in_range("The static friction of " + shape, surface.static_friction, 0.0f, protocol::friction_maximum, "");
  if (!(surface.dynamic_friction >= 0.0f && surface.dynamic_friction <= surface.static_friction))
    throw Error(fmt::format("The dynamic friction of {} is {}. Give a number from 0 to its static friction, {}.", shape,
                            surface.dynamic_friction, surface.static_friction));
  require_in_range("The viscosity of " + shape, surface.viscosity_Ns_per_m, 0.0f, damping.maximum, " Ns/m");
}

protocol::SurfaceEntry surface_entry(const std::string& shape, const Surface& surface) {
  require_properties(shape, {surface.stiffness_N_per_m, surface.damping_Ns_per_m, surface.static_friction,
                             surface.dynamic_friction, surface.viscosity_Ns_per_m});
  if (!(std::isinf(surface.life_s) && surface.life_s > 0.0f))
    require_in_range("The life of " + shape, surface.life_s, protocol::servo_period_s, protocol::shape_life_maximum_s,
                     " s, or infinity");
  return {surface.stiffness_N_per_m, surface.damping_Ns_per_m,   surface.static_friction,
          surface.dynamic_friction,  surface.viscosity_Ns_per_m, surface.life_s};
}

struct KindOfSolid {
  const char* name;
  std::size_t sizes;  ///< number of used sizes
  float smallest_m;   ///< smallest size
};

KindOfSolid kind_of(protocol::SolidKind kind) {
  switch (kind) {
    case protocol::SolidKind::sphere: return {"sphere", 1, 1e-6f};
    case protocol::SolidKind::capsule: return {"capsule", 2, 1e-6f};
    case protocol::SolidKind::cylinder: return {"cylinder", 2, protocol::solid_rounding_m};
    case protocol::SolidKind::box: return {"box", 3, protocol::solid_rounding_m};
  }
  throw Error("A solid has an unknown kind. Give sphere, capsule, cylinder or box.");
}

protocol::SolidEntry solid_entry(const Solid& solid, std::size_t number) {
  const KindOfSolid kind = kind_of(solid.kind);
  const std::string name = fmt::format("solid {} ({})", number, kind.name);
  require_coordinates("A coordinate of " + name, solid.centre_m);
  for (std::size_t i = 0; i < kind.sizes; ++i)
    require_in_range("A size of " + name, solid.size_m[i], kind.smallest_m, protocol::shape_distance_maximum_m, " m");
  protocol::SolidEntry entry{};
  entry.kind = solid.kind;
  copy(solid.centre_m, entry.centre_m);
  copy(solid.size_m, entry.size_m);
  float squared = 0.0f;
  for (std::size_t i = 0; i < solid.orientation.size(); ++i) {
    entry.orientation[i] = solid.orientation[i];
    squared += solid.orientation[i] * solid.orientation[i];
  }
  if (!(squared > 0.01f && squared < 100.0f))
    throw Error(
        fmt::format("The orientation of {} is not a rotation. Give a quaternion w, x, y, z of length 1.", name));
  entry.surface = surface_entry(name, solid.surface);
  return entry;
}

// ---- local models ----

using Triple = std::array<float, 3>;

float dot(const Triple& a, const Triple& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

/// Returns a value in steps, limited to the range of the integer.
template <class Integer>
Integer in_steps(float value, float step) {
  constexpr auto least = static_cast<float>(std::numeric_limits<Integer>::min());
  constexpr auto most = static_cast<float>(std::numeric_limits<Integer>::max());
  return static_cast<Integer>(std::lround(std::clamp(value / step, least, most)));
}

template <class Integer>
void put_steps(const Triple& values, float step, Integer (&to)[3]) {
  for (std::size_t i = 0; i < 3; ++i) to[i] = in_steps<Integer>(values[i], step);
}

bool fits(float length_m) {
  return std::fabs(length_m) < protocol::local_length_step_m * std::numeric_limits<std::int16_t>::max();
}

/// Nearest point of the surface to the anchor.
struct Nearest {
  Triple normal;
  float height_m;  ///< of the anchor
};

Nearest nearest(const Feature& feature, const Triple& anchor_m) {
  Triple out_m{};
  for (std::size_t i = 0; i < 3; ++i) out_m[i] = anchor_m[i] - feature.point_m[i];
  const float along_m = dot(out_m, feature.direction);
  if (feature.kind == protocol::FeatureKind::plane) return {feature.direction, along_m};
  if (feature.kind == protocol::FeatureKind::cylinder)
    for (std::size_t i = 0; i < 3; ++i) out_m[i] -= along_m * feature.direction[i];
  const float distance_m = std::sqrt(dot(out_m, out_m));
  if (!(distance_m > 1e-7f)) return {feature.direction, -feature.radius_m};  // at the center any normal is valid
  for (float& each : out_m) each /= distance_m;
  return {out_m, distance_m - feature.radius_m};
}

void put_pair(const std::array<std::int16_t, 2>& pair, std::int16_t (&to)[2]) {
  to[0] = pair[0];
  to[1] = pair[1];
}

/// `cylinder_radius_m` is the radius of the cylinders of the report, or 0 before the first cylinder.
protocol::FeatureEntry feature_entry(const Feature& feature, const Triple& anchor_m, float& cylinder_radius_m) {
  for (const Triple* values : {&feature.direction, &feature.point_m})
    for (const float value : *values)
      if (!std::isfinite(value)) throw Error("A feature of the local model has a number that is not finite.");
  if (feature.material < 0 || feature.material >= static_cast<int>(protocol::materials_maximum))
    throw Error(fmt::format("Material {} does not exist. Give a number from 0 to {}.", feature.material,
                            protocol::materials_maximum - 1));
  const float step_m = protocol::local_length_step_m;
  protocol::FeatureEntry entry{};
  entry.kind = protocol::FeatureKind::plane;
  entry.material = static_cast<std::uint8_t>(feature.material & 0xF);
  entry.moves = feature.moves ? 1 : 0;
  const Nearest at_anchor = nearest(feature, anchor_m);
  if (!fits(at_anchor.height_m))
    throw Error(fmt::format("A feature of the local model is {} m from the anchor. Choose an anchor near the tip.",
                            at_anchor.height_m));
  if (feature.kind == protocol::FeatureKind::cylinder && fits(feature.radius_m) &&
      (cylinder_radius_m == 0.0f || cylinder_radius_m == feature.radius_m)) {
    put_pair(protocol::encode_direction(feature.direction), entry.direction);
    const auto across = protocol::across(protocol::decode_direction(entry.direction));
    Triple to_axis_m{};
    for (std::size_t i = 0; i < 3; ++i) to_axis_m[i] = feature.point_m[i] - anchor_m[i];
    const float first_m = dot(to_axis_m, across[0]), second_m = dot(to_axis_m, across[1]);
    if (fits(first_m) && fits(second_m)) {
      cylinder_radius_m = feature.radius_m;
      entry.kind = protocol::FeatureKind::cylinder;
      put_pair({in_steps<std::int16_t>(first_m, step_m), in_steps<std::int16_t>(second_m, step_m)}, entry.lengths);
      return entry;
    }
  }
  put_pair(protocol::encode_direction(at_anchor.normal), entry.direction);
  entry.lengths[0] = in_steps<std::int16_t>(at_anchor.height_m, step_m);
  if (feature.kind == protocol::FeatureKind::sphere && fits(feature.radius_m)) {
    entry.kind = protocol::FeatureKind::sphere;
    entry.lengths[1] = in_steps<std::int16_t>(feature.radius_m, step_m);
  }
  return entry;
}

}  // namespace

protocol::ForceReport force_report(const ForceRequest& request) {
  for (const float force_N : request.force_N)
    if (!std::isfinite(force_N))
      throw Error(fmt::format("The force is {} N on one axis. Give finite numbers.", force_N));
  if (request.interval_ms < 1 || request.interval_ms > protocol::force_interval_maximum_ms)
    throw Error(fmt::format("A force for {} ms cannot be sent. Send a force every 1 to {} ms, and give this interval.",
                            request.interval_ms, protocol::force_interval_maximum_ms));
  protocol::ForceReport report{};
  report.mode = request.mode;
  report.interval_ms = static_cast<std::uint8_t>(request.interval_ms);
  copy(request.force_N, report.force_N);
  return report;
}

protocol::ShapesReport shapes_report(const Shapes& shapes) {
  protocol::ShapesReport report{};
  for (std::size_t i = 0; i < shapes.planes.size(); ++i) {
    if (!shapes.planes[i]) continue;
    const Plane& plane = *shapes.planes[i];
    const std::string name = fmt::format("plane {}", i);
    require_coordinates("A coordinate of " + name, plane.point_m);
    require_coordinates("A coordinate of the normal of " + name, plane.normal);
    if (std::hypot(plane.normal[0], plane.normal[1], plane.normal[2]) < 1e-5f)
      throw Error(fmt::format("The normal of {} has length 0. Give a normal that points into the free space.", name));
    copy(plane.point_m, report.planes[i].point_m);
    copy(plane.normal, report.planes[i].normal);
    report.planes[i].surface = surface_entry(name, plane.surface);
    report.plane_count = static_cast<std::uint8_t>(i + 1);
  }
  if (shapes.sphere) {
    const Sphere& sphere = *shapes.sphere;
    require_coordinates("A coordinate of the sphere", sphere.centre_m);
    if (!(sphere.radius_m > 0.0f)) throw Error("The sphere's radius is not above 0 m. Give a radius above 0 m.");
    require_in_range("The sphere's radius", sphere.radius_m, 0.0f, protocol::shape_distance_maximum_m, " m");
    copy(sphere.centre_m, report.sphere.centre_m);
    report.sphere.radius_m = sphere.radius_m;
    report.sphere.surface = surface_entry("the sphere", sphere.surface);
  }
  if (shapes.solids.size() > protocol::shape_solids_maximum)
    throw Error(fmt::format("{} solids are too many. Give the {} nearest solids.", shapes.solids.size(),
                            protocol::shape_solids_maximum));
  for (std::size_t i = 0; i < shapes.solids.size(); ++i) report.solids[i] = solid_entry(shapes.solids[i], i);
  report.solid_count = static_cast<std::uint8_t>(shapes.solids.size());
  if (shapes.materials.size() > protocol::materials_maximum)
    throw Error(fmt::format("{} materials are too many. Give at most {}.", shapes.materials.size(),
                            protocol::materials_maximum));
  for (std::size_t i = 0; i < shapes.materials.size(); ++i) {
    require_properties(fmt::format("material {}", i), shapes.materials[i]);
    report.materials[i] = shapes.materials[i];
  }
  report.material_count = static_cast<std::uint8_t>(shapes.materials.size());
  return report;
}

protocol::LocalModelReport local_model_report(const LocalModel& model, const ForceRequest& force) {
  if (model.count > model.features.size())
    throw Error(fmt::format("{} features are too many. Give at most {}.", model.count, model.features.size()));
  if (model.life_ms < 1 || model.life_ms > protocol::local_model_life_maximum_ms)
    throw Error(fmt::format("A local model cannot live for {} ms. Give 1 to {} ms.", model.life_ms,
                            protocol::local_model_life_maximum_ms));
  for (const Triple* values : {&model.anchor_m, &model.velocity_m_per_s, &model.spin_rad_per_s})
    for (const float value : *values)
      if (!std::isfinite(value)) throw Error("The local model has a number that is not finite.");
  const protocol::ForceReport checked = force_report(force);
  protocol::LocalModelReport report{};
  report.mode = checked.mode;
  report.interval_ms = checked.interval_ms;
  report.life_ms = static_cast<std::uint8_t>(model.life_ms);
  put_steps(model.anchor_m, protocol::local_anchor_step_m, report.anchor);
  put_steps(model.velocity_m_per_s, protocol::local_speed_step_m_per_s, report.velocity);
  put_steps(model.spin_rad_per_s, protocol::local_spin_step_rad_per_s, report.spin);
  put_steps(force.force_N, protocol::local_force_step_N, report.force);
  Triple anchor_m{};
  for (std::size_t i = 0; i < 3; ++i)
    anchor_m[i] = protocol::local_anchor_step_m * static_cast<float>(report.anchor[i]);
  float cylinder_radius_m = 0.0f;
  report.feature_count = static_cast<std::uint8_t>(model.count);
  for (std::size_t i = 0; i < model.count; ++i)
    report.features[i] = feature_entry(model.features[i], anchor_m, cylinder_radius_m);
  report.cylinder_radius = in_steps<std::uint16_t>(cylinder_radius_m, protocol::local_length_step_m);
  return report;
}

}  // namespace inkwell::device
