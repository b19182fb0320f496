// Triangles as a file contains them.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include "host/geometry/mesh.hpp"
#include "host/import/unit.hpp"

namespace inkwell::importer {

/// Larger files and objects are refused, so that a forged file cannot exhaust the memory.
inline constexpr std::size_t file_bytes_max = std::size_t{1} << 30;
inline constexpr std::size_t triangles_max = 5'000'000;
inline constexpr std::size_t vertices_max = 3 * triangles_max;

struct FileContent {
  std::vector<glm::dvec3> vertices{};  ///< in the unit of the file
  std::vector<geometry::Face> faces{};
  std::optional<Unit> unit{};          ///< if the format or the file states a unit
  bool is_unit_doubtful = false;       ///< many programs write another unit than the format states
  std::vector<std::string> remarks{};  ///< sentences for the user
};

/// @throws Error if there is no triangle, if an index has no vertex, or if a used coordinate is not a finite number.
/// `name`: name of the file in the sentence.
void check(const FileContent& content, const std::string& name);

/// @throws Error if the count exceeds its limit.
void check_counts(std::size_t vertices, std::size_t triangles, const std::string& name);

}  // namespace inkwell::importer
