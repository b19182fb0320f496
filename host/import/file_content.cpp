#include "host/import/file_content.hpp"

#include <cmath>

#include <fmt/format.h>

#include "host/import/error.hpp"

namespace inkwell::importer {
namespace {

/// Larger coordinates overflow in the computation of volumes.
constexpr double coordinate_max = 1e12;

}  // namespace

void check_counts(std::size_t vertices, std::size_t triangles, const std::string& name) {
  if (triangles > triangles_max || vertices > vertices_max)
    throw Error(fmt::format("{} has more than {} million triangles. Reduce the object in a mesh editor.", name,
                            triangles_max / 1'000'000));
}

void check(const FileContent& content, const std::string& name) {
  if (content.faces.empty())
    throw Error(
        fmt::format("{} contains no triangles, so there is nothing to touch. Export the object as a mesh.", name));
  check_counts(content.vertices.size(), content.faces.size(), name);
  for (std::size_t face = 0; face < content.faces.size(); ++face) {
    for (const std::uint32_t index : content.faces[face]) {
      if (index >= content.vertices.size())
        throw Error(
            fmt::format("Triangle {} of {} refers to vertex {}, but there are only {} vertices. Export the file "
                        "again.",
                        face + 1, name, index + std::size_t{1}, content.vertices.size()));
      const glm::dvec3& vertex = content.vertices[index];
      for (int axis = 0; axis < 3; ++axis)
        if (!(std::abs(vertex[axis]) <= coordinate_max))
          throw Error(
              fmt::format("A corner of triangle {} of {} has the coordinate {}, which is not a usable number. "
                          "Export the file again.",
                          face + 1, name, vertex[axis]));
    }
  }
}

}  // namespace inkwell::importer
