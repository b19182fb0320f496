#include "host/client/device/program_force.hpp"

#include <cmath>
#include <cstring>
#include <string>

#include <fmt/format.h>

#include "host/client/device/error.hpp"

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

protocol::SurfaceEntry surface_entry(const std::string& shape, const Surface& surface) {
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
  if (!(std::isinf(surface.life_s) && surface.life_s > 0.0f))
    require_in_range("The life of " + shape, surface.life_s, protocol::servo_period_s, protocol::shape_life_maximum_s,
                     " s, or infinity");
  return {surface.stiffness_N_per_m, surface.damping_Ns_per_m, surface.static_friction, surface.dynamic_friction,
          surface.life_s};
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
  return report;
}

}  // namespace inkwell::device
