// Readers on top of libraries. They run in the child process, because the libraries may crash on damaged files.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "host/import/file_content.hpp"

namespace inkwell::importer {

/// All readers throw Error. `name`: name of the file in the sentence.

/// Reads an OBJ file with tinyobjloader: faces, but no curves. Joins continued lines, which the library does not.
FileContent read_obj(const std::filesystem::path& file, const std::string& name);

/// Reads a glTF 2 file with tinygltf, .gltf or .glb: the triangles of the default scene in its rest pose. A required
/// extension that changes the shape is refused.
FileContent read_gltf(const std::filesystem::path& file, const std::string& name);

/// Reads a VRML97, VRML 1 or Inventor file with Coin, also compressed with gzip.
FileContent read_vrml(const std::filesystem::path& file, const std::string& name);

/// Reads a whole regular file. @throws Error if it is missing or too large.
std::vector<std::byte> read_file(const std::filesystem::path& file, const std::string& name);

}  // namespace inkwell::importer
