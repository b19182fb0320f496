// Bodies made by formulas, for `inkwell feel --example` and for tests.
#pragma once

#include <functional>
#include <span>
#include <string_view>
#include <vector>

#include <glm/vec2.hpp>

#include "host/geometry/mesh.hpp"

namespace inkwell::geometry {

struct Example {
  std::string_view name;
  std::string_view description;
  Mesh (*make)();
};

/// All bodies are closed, and their middle is near the origin. They fit into the workspace of the arm.
std::span<const Example> examples();

/// Corners of a polygon without crossings, counter-clockwise.
using Outline = std::vector<glm::dvec2>;

/// Sphere from an icosahedron with 20 * 4^subdivisions faces. The bumps are waves with this amplitude.
Mesh make_ball(double radius_m, double bumps_m, unsigned subdivisions);
/// Torus about z.
Mesh make_torus(double radius_m, double tube_radius_m, unsigned around, unsigned around_tube);
/// Cylinder about z with flat ends.
Mesh make_cylinder(double radius_m, double height_m, unsigned around);
/// Box with edges along the axes.
Mesh make_box(const glm::dvec3& size_m);
/// Prism along z, from -height_m / 2 to height_m / 2. The outline is simple and has at least three corners.
Mesh extrude(const Outline& outline_m, double height_m);
/// Prism between two outlines with equal counts of corners. The inner outline is the border of a hole, and each of its
/// corners is connected with the same corner of the outer outline.
Mesh extrude_ring(const Outline& outer_m, const Outline& inner_m, double height_m);
/// Closed mesh of the points at which the function is negative, by marching tetrahedra. The cube from -half_size_m to
/// half_size_m has cells^3 cells, and the function must be positive on its border.
Mesh make_implicit(const std::function<double(const glm::dvec3& point_m)>& distance_m, double half_size_m,
                   unsigned cells);

}  // namespace inkwell::geometry
