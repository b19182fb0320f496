#include "host/import/placement.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "host/import/unit.hpp"

namespace inkwell::importer {
namespace {

constexpr double filled_share = 0.8;
/// The radius of the tip is about 1 mm, so smaller objects feel like a point.
constexpr double smallest_m = 2e-3;

glm::dvec3 size_of_box(const geometry::Box& box) { return glm::dvec3(box.maximum_m) - glm::dvec3(box.minimum_m); }

glm::dvec3 middle_of(const geometry::Box& box) { return 0.5 * (glm::dvec3(box.maximum_m) + glm::dvec3(box.minimum_m)); }

double longest(const glm::dvec3& size) { return std::max({size.x, size.y, size.z}); }

/// Factor that makes the object as large as the workspace.
double largest_scale(const geometry::Box& object, const geometry::Box& workspace) {
  const glm::dvec3 size = size_of_box(object), space = size_of_box(workspace);
  double scale = std::numeric_limits<double>::infinity();
  for (int axis = 0; axis < 3; ++axis)
    if (size[axis] > 0) scale = std::min(scale, space[axis] / size[axis]);
  return scale;
}

}  // namespace

Placement drop_to_origin(const geometry::Box& object) { return {1, -middle_of(object)}; }

Placement fit_to_workspace(const geometry::Box& object, const geometry::Box& workspace) {
  const double largest = largest_scale(object, workspace);
  const double scale = std::isfinite(largest) ? filled_share * largest : 1;
  return {scale, middle_of(workspace) - scale * middle_of(object)};
}

void apply(const Placement& placement, geometry::Mesh& mesh) {
  for (glm::vec3& vertex_m : mesh.vertices_m) vertex_m = placement.scale * glm::dvec3(vertex_m) + placement.offset_m;
}

double propose_scale(const geometry::Box& object, const geometry::Box& workspace) {
  const double largest = largest_scale(object, workspace);
  const bool is_too_large = largest < 1, is_too_small = longest(size_of_box(object)) < smallest_m;
  if ((!is_too_large && !is_too_small) || !std::isfinite(largest)) return 1;
  const double scale = filled_share * largest;
  const double power = std::pow(10.0, std::floor(std::log10(scale)));
  return std::floor(scale / power) * power;
}

std::string size_remark(const geometry::Box& object, const geometry::Box& workspace) {
  const double scale = propose_scale(object, workspace);
  if (scale == 1) return {};
  const glm::dvec3 space = size_of_box(workspace);
  const double times = 1 / largest_scale(object, workspace);
  const std::string remedy = fmt::format("Use --scale {:.1g}.", scale);
  if (scale > 1)
    return fmt::format("The object is only {} long, so it feels like a point. {}",
                       length_text(longest(size_of_box(object))), remedy);
  return fmt::format("The object is {} long, {:.{}f} times too large for the workspace of {} x {} x {}. {}",
                     length_text(longest(size_of_box(object))), times, times < 10 ? 1 : 0, length_text(space.x),
                     length_text(space.y), length_text(space.z), remedy);
}

}  // namespace inkwell::importer
