// Messages from the helper program inkwell-import to its starter, over a pipe of one computer.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "host/import/file_content.hpp"

namespace inkwell::importer {

/// Largest message: all vertices, all triangles and the texts.
inline constexpr std::size_t message_bytes_max =
    vertices_max * sizeof(glm::dvec3) + triangles_max * sizeof(geometry::Face) + (std::size_t{1} << 20);

std::vector<std::byte> encode(const FileContent& content);

/// `sentence`: the text of the Error that decode() throws.
std::vector<std::byte> encode_refusal(std::string_view sentence);

/// The helper program may have failed at any byte, so every field is checked.
/// @throws Error for a refusal, and for an incomplete or invalid message. `name`: name of the file in the sentence.
FileContent decode(std::span<const std::byte> message, const std::string& name);

}  // namespace inkwell::importer
