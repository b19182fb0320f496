// Readers of STL and PLY files. No Debian library reads all variants of these two formats: assimp loses triangles and
// Coin reads neither.
#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "host/import/file_content.hpp"

namespace inkwell::importer {

/// Reads an STL file. The size of the file and its first bytes decide between ASCII and binary, because some binary
/// files start with "solid". Bytes after the last binary triangle are ignored.
/// Source: 3D Systems, Stereolithography Interface Specification, 1988.
/// @throws Error. `name`: name of the file in the sentence.
FileContent read_stl(std::span<const std::byte> file, const std::string& name);

/// Reads a PLY file in ASCII or binary in both byte orders, with elements and properties in any order, polygons and
/// triangle strips. Source: Greg Turk, The PLY Polygon File Format, 1994.
/// @throws Error. `name`: name of the file in the sentence.
FileContent read_ply(std::span<const std::byte> file, const std::string& name);

}  // namespace inkwell::importer
