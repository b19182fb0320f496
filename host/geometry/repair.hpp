// Measures and repairs meshes as files contain them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "host/geometry/mesh.hpp"

namespace inkwell::geometry {

/// Size and topology of a mesh. A part consists of triangles that are connected by edges.
struct Measurements {
  std::size_t triangles = 0;
  std::size_t vertices = 0;
  std::size_t parts = 0;
  std::size_t closed_parts = 0;    ///< each edge is used equally often in both directions
  std::size_t open_edges = 0;      ///< edges of one triangle
  std::size_t branched_edges = 0;  ///< edges of three or more triangles
  std::size_t flipped_edges = 0;   ///< edges whose two triangles have opposite orientations
  double area_m2 = 0;
  double volume_m3 = 0;  ///< of the closed parts; negative for a part that is inside out
  Box box;

  /// An open mesh is a surface with two sides. A closed mesh encloses a volume.
  bool is_closed() const { return parts > 0 && closed_parts == parts; }
};

/// Counts of the repairs.
struct Repairs {
  std::size_t degenerate = 0;    ///< removed triangles without area
  std::size_t needles = 0;       ///< replaced triangles of almost no height, whose edges belong to other triangles
  std::size_t duplicates = 0;    ///< removed copies of triangles
  std::size_t turned = 0;        ///< triangles whose orientation differed from their neighbors
  std::size_t turned_parts = 0;  ///< closed parts that were inside out

  bool any() const { return degenerate + needles + duplicates + turned + turned_parts > 0; }
};

/// The repaired mesh and the repairs.
struct Report {
  Measurements measurements;
  Repairs repairs;
};

/// The mesh must be valid and welded.
Measurements measure(const Mesh& mesh);

/// Removes degenerate and duplicate triangles, gives the triangles of each part one orientation, and turns closed parts
/// that are inside out. A cavity is a part inside another part, and its triangles face the cavity. The mesh must be
/// valid and welded, and remains so. `sources`: becomes the number that each remaining triangle had before the repair.
Report repair(Mesh& mesh, std::vector<std::uint32_t>* sources = nullptr);

}  // namespace inkwell::geometry
