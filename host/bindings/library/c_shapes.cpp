// Functions of the C interface for shapes that the board renders.
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "host/bindings/library/c_guard.hpp"
#include "host/bindings/library/growing_struct.hpp"

using namespace inkwell::library;
namespace device = inkwell::device;
namespace protocol = inkwell::protocol;

namespace {

// Programs contain these layouts. New members are appended.
static_assert(offsetof(inkwell_solid, viscosity_Ns_per_m) == 128 && offsetof(inkwell_shapes, solid_size) == 40);
static_assert(INKWELL_PLANES_MAXIMUM == protocol::shape_planes_maximum);
static_assert(INKWELL_SOLIDS_MAXIMUM == protocol::shape_solids_maximum);
static_assert(INKWELL_SHAPE_SPHERE == static_cast<int>(protocol::SolidKind::sphere) &&
              INKWELL_SHAPE_CAPSULE == static_cast<int>(protocol::SolidKind::capsule) &&
              INKWELL_SHAPE_CYLINDER == static_cast<int>(protocol::SolidKind::cylinder) &&
              INKWELL_SHAPE_BOX == static_cast<int>(protocol::SolidKind::box));

std::array<float, 3> floats(const double (&values)[3]) {
  return {static_cast<float>(values[0]), static_cast<float>(values[1]), static_cast<float>(values[2])};
}

device::Surface surface_of(const inkwell_surface& surface, double viscosity_Ns_per_m) {
  return {static_cast<float>(surface.stiffness_N_per_m), static_cast<float>(surface.damping_Ns_per_m),
          static_cast<float>(surface.static_friction),   static_cast<float>(surface.dynamic_friction),
          static_cast<float>(viscosity_Ns_per_m),        static_cast<float>(surface.life_s)};
}

/// A quaternion of zeros stands for the unturned solid.
std::array<float, 4> orientation_of(const double (&quaternion)[4]) {
  const auto& [x, y, z, w] = quaternion;
  if (x == 0 && y == 0 && z == 0 && w == 0) return {1, 0, 0, 0};
  return {static_cast<float>(w), static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)};
}

void require_count(std::size_t count, std::size_t maximum, const char* things) {
  if (count > maximum)
    throw BadArgument(fmt::format("{} {} are too many. Give the {} nearest {}.", count, things, maximum, things));
}

device::Solid solid_of(const inkwell_solid& solid) {
  if (solid.shape < INKWELL_SHAPE_SPHERE || solid.shape > INKWELL_SHAPE_BOX)
    throw BadArgument(fmt::format("The board has no solid of kind {}. Give a sphere, capsule, cylinder or box.",
                                  static_cast<int>(solid.shape)));
  return {static_cast<protocol::SolidKind>(solid.shape), floats(solid.centre_m), orientation_of(solid.quaternion),
          floats(solid.size_m), surface_of(solid.surface, solid.viscosity_Ns_per_m)};
}

void place(inkwell_arm* arm, const device::Shapes& shapes) {
  try {
    device::shapes_report(shapes);
  } catch (const device::Error& error) {
    throw BadArgument(error.what());
  }
  arm_of(arm).place_shapes(shapes);
}

void add_planes(device::Shapes& shapes, const inkwell_plane* planes, std::size_t count, const double* viscosities) {
  require_count(count, protocol::shape_planes_maximum, "planes");
  if (count > 0) required(planes, "The list of planes");
  for (std::size_t i = 0; i < count; ++i)
    if (planes[i].surface.life_s != 0.0)
      shapes.planes[i] = device::Plane{floats(planes[i].point_m), floats(planes[i].normal),
                                       surface_of(planes[i].surface, viscosities != nullptr ? viscosities[i] : 0)};
}

}  // namespace

inkwell_result inkwell_place_shapes(inkwell_arm* arm, const inkwell_plane* planes, size_t plane_count,
                                    const inkwell_sphere* sphere) {
  return guarded([&] {
    device::Shapes shapes;
    add_planes(shapes, planes, plane_count, nullptr);
    if (sphere != nullptr && sphere->surface.life_s != 0.0)
      shapes.sphere = device::Sphere{floats(sphere->centre_m), static_cast<float>(sphere->radius_m),
                                     surface_of(sphere->surface, 0)};
    place(arm, shapes);
  });
}

inkwell_result inkwell_place_all_shapes(inkwell_arm* arm, const inkwell_shapes* given, size_t size) {
  return guarded([&] {
    required(given, "The pointer to the shapes");
    check_size(size, sizeof(inkwell_shapes), "inkwell_shapes");
    device::Shapes shapes;
    add_planes(shapes, given->planes, given->plane_count, given->plane_viscosity_Ns_per_m);
    require_count(given->solid_count, protocol::shape_solids_maximum, "solids");
    if (given->solid_count > 0) {
      required(given->solids, "The list of solids");
      check_size(given->solid_size, sizeof(inkwell_solid), "inkwell_solid");
    }
    for (std::size_t i = 0; i < given->solid_count; ++i) {
      const inkwell_solid solid = element(given->solids, i, given->solid_size);
      if (solid.surface.life_s != 0.0) shapes.solids.push_back(solid_of(solid));
    }
    place(arm, shapes);
  });
}
