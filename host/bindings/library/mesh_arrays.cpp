#include "host/bindings/library/mesh_arrays.hpp"

#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "host/geometry/repair.hpp"
#include "protocol/reports.hpp"

#include "host/bindings/library/errors.hpp"

namespace inkwell::library {
namespace {

template <class Number>
std::vector<glm::vec3> read_vertices(const inkwell_mesh& mesh) {
  const auto* const numbers = static_cast<const Number*>(mesh.vertices_m);
  std::vector<glm::vec3> vertices_m(mesh.vertex_count);
  for (std::size_t vertex = 0; vertex < mesh.vertex_count; ++vertex)
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const Number coordinate_m = numbers[3 * vertex + axis];
      if (!(std::abs(coordinate_m) <= static_cast<Number>(protocol::shape_distance_maximum_m)))
        throw BadArgument(fmt::format("A coordinate of vertex {} is {} m. Give a number from {} to {} m.", vertex,
                                      coordinate_m, -protocol::shape_distance_maximum_m,
                                      protocol::shape_distance_maximum_m));
      vertices_m[vertex][static_cast<int>(axis)] = static_cast<float>(coordinate_m);
    }
  return vertices_m;
}

template <class Index>
std::vector<geometry::Face> read_triangles(const inkwell_mesh& mesh) {
  const auto* const indices = static_cast<const Index*>(mesh.triangles);
  std::vector<geometry::Face> triangles(mesh.triangle_count);
  for (std::size_t triangle = 0; triangle < mesh.triangle_count; ++triangle)
    for (std::size_t corner = 0; corner < 3; ++corner) {
      const Index index = indices[3 * triangle + corner];
      if (std::cmp_less(index, 0) || std::cmp_greater_equal(index, mesh.vertex_count))
        throw BadArgument(fmt::format("Triangle {} has the vertex {}, but the mesh has {} vertices. Count from 0.",
                                      triangle, index, mesh.vertex_count));
      triangles[triangle][corner] = static_cast<std::uint32_t>(index);
    }
  return triangles;
}

std::vector<glm::vec3> vertices_of(const inkwell_mesh& mesh) {
  switch (mesh.vertex_type) {
    case INKWELL_FLOAT32: return read_vertices<float>(mesh);
    case INKWELL_FLOAT64: return read_vertices<double>(mesh);
    default: throw BadArgument("The vertices have no known type. Give INKWELL_FLOAT32 or INKWELL_FLOAT64.");
  }
}

std::vector<geometry::Face> triangles_of(const inkwell_mesh& mesh) {
  switch (mesh.triangle_type) {
    case INKWELL_INT32: return read_triangles<std::int32_t>(mesh);
    case INKWELL_UINT32: return read_triangles<std::uint32_t>(mesh);
    case INKWELL_INT64: return read_triangles<std::int64_t>(mesh);
    case INKWELL_UINT64: return read_triangles<std::uint64_t>(mesh);
    default: throw BadArgument("The triangles have no known type. Give one of the integer types of inkwell_number.");
  }
}

void require_counts(const inkwell_mesh& mesh) {
  if (mesh.vertices_m == nullptr || mesh.triangles == nullptr || mesh.vertex_count == 0 || mesh.triangle_count == 0)
    throw BadArgument("The mesh is empty. Give at least three vertices and a triangle.");
  if (mesh.triangle_count > geometry::faces_max || mesh.vertex_count > 3 * geometry::faces_max)
    throw BadArgument(fmt::format("The mesh has {} triangles and {} vertices. Give at most {} triangles.",
                                  mesh.triangle_count, mesh.vertex_count, geometry::faces_max));
}

}  // namespace

std::shared_ptr<const geometry::Surface> surface_of_arrays(const inkwell_mesh& mesh) {
  require_counts(mesh);
  geometry::Mesh welded = geometry::weld(vertices_of(mesh), triangles_of(mesh));
  std::vector<std::uint32_t> sources;
  geometry::repair(welded, &sources);
  if (welded.faces.empty())
    throw BadArgument("The mesh has only triangles without area, so there is nothing to touch. Check its vertices.");
  return geometry::Surface::build(std::move(welded), {}, sources);
}

}  // namespace inkwell::library
