// Reads objects from files: STL, OBJ, PLY, glTF and VRML.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include "host/geometry/mesh.hpp"
#include "host/geometry/repair.hpp"
#include "host/import/child_reader.hpp"
#include "host/import/error.hpp"
#include "host/import/format.hpp"
#include "host/import/unit.hpp"

namespace inkwell::importer {

struct ImportOptions {
  std::optional<Unit> unit{};  ///< replaces the unit of the file
  double scale = 1;            ///< factor for all lengths; positive
  ChildLimits limits{};
  Progress progress{};  ///< called in the thread of import_object()
};

enum class UnitSource : std::uint8_t { file, user, proposal };

struct Object {
  std::string name{};  ///< of the file
  Format format{};
  geometry::Mesh mesh{};   ///< welded and repaired; relative to the middle of its box
  glm::dvec3 middle_m{0};  ///< middle of the box in the coordinates of the file
  geometry::Report report{};
  Unit unit{};
  UnitSource unit_source{};
  std::vector<std::string> remarks{};  ///< sentences for the user, such as repairs
};

/// Reads, scales, welds, repairs and measures an object. Needs up to 200 bytes for each triangle of the file.
/// @throws Error if the file cannot be used, or if `progress` cancels the work.
Object import_object(const std::filesystem::path& file, const ImportOptions& options = {});

/// Sentences about the repairs and about an open mesh.
std::vector<std::string> remarks_on(const geometry::Report& report);

}  // namespace inkwell::importer
