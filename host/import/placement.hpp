// Size and position of an object in the workspace of an arm.
#pragma once

#include <string>

#include <glm/vec3.hpp>

#include "host/geometry/mesh.hpp"

namespace inkwell::importer {

/// A point x of the object goes to scale x + offset.
struct Placement {
  double scale = 1;
  glm::dvec3 offset_m{0};
};

/// Places the middle of the box at the origin, without scaling.
Placement drop_to_origin(const geometry::Box& object);

/// Largest placement inside the workspace, with its middle in the middle of the workspace. The object leaves a tenth of
/// each side free, so that the arm can move around it. A box without size is only moved.
Placement fit_to_workspace(const geometry::Box& object, const geometry::Box& workspace);

void apply(const Placement& placement, geometry::Mesh& mesh);

/// Scale factor with one digit for an object that is too large for the workspace, or too small to feel. Returns 1
/// for an object of suitable size.
double propose_scale(const geometry::Box& object, const geometry::Box& workspace);

/// A sentence if the size of the object does not suit the workspace, with a remedy. Otherwise empty.
std::string size_remark(const geometry::Box& object, const geometry::Box& workspace);

}  // namespace inkwell::importer
