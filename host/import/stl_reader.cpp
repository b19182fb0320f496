#include <bit>
#include <cstdint>
#include <cstring>

#include <fmt/format.h>

#include "host/client/local/text_file.hpp"

#include "host/import/error.hpp"
#include "host/import/readers.hpp"
#include "host/import/text_scanner.hpp"

namespace inkwell::importer {
namespace {

static_assert(std::endian::native == std::endian::little, "binary STL files are little-endian");

constexpr std::size_t header_bytes = 84, triangle_bytes = 50, normal_bytes = 12;

std::string_view stl_text(std::span<const std::byte> file) {
  return local::without_byte_order_mark({reinterpret_cast<const char*>(file.data()), file.size()});
}

std::uint32_t triangle_count(std::span<const std::byte> file) {
  std::uint32_t count = 0;
  std::memcpy(&count, file.data() + header_bytes - sizeof count, sizeof count);
  return count;
}

/// True for a text that starts with "solid" and contains a facet or the end of the solid.
bool is_ascii(std::span<const std::byte> file) {
  constexpr std::size_t examined_bytes = 4096;
  const auto begin = stl_text(file).substr(0, examined_bytes);
  TextScanner scanner(begin);
  if (!is_word(scanner.word(), "solid")) return false;
  // A binary file contains zero bytes soon after its header.
  if (begin.find('\0') != begin.npos) return false;
  scanner.line();
  while (!scanner.is_at_end())
    if (const auto word = scanner.word(); is_word(word, "facet") || is_word(word, "endsolid")) return true;
  return false;
}

void append_corner(FileContent& content, const glm::dvec3& corner) {
  const auto index = static_cast<std::uint32_t>(content.vertices.size());
  content.vertices.push_back(corner);
  if (index % 3 == 2) content.faces.push_back({index - 2, index - 1, index});
}

FileContent read_binary_stl(std::span<const std::byte> file, const std::string& name) {
  const std::size_t count = triangle_count(file);
  if (const std::size_t contained = (file.size() - header_bytes) / triangle_bytes; count > contained)
    throw Error(
        fmt::format("{} announces {} triangles but contains only {}, so the file is incomplete or is not an STL "
                    "file. Copy or export the file again.",
                    name, count, contained));
  check_counts(3 * count, count, name);
  FileContent content;
  content.vertices.reserve(3 * count);
  content.faces.reserve(count);
  const std::byte* triangle = file.data() + header_bytes;
  for (std::size_t face = 0; face < count; ++face, triangle += triangle_bytes) {
    float corners[9];
    std::memcpy(corners, triangle + normal_bytes, sizeof corners);
    for (std::size_t corner = 0; corner < 9; corner += 3)
      append_corner(content, {corners[corner], corners[corner + 1], corners[corner + 2]});
  }
  return content;
}

FileContent read_ascii_stl(std::span<const std::byte> file, const std::string& name) {
  TextScanner scanner(stl_text(file));
  FileContent content;
  std::size_t corners = 0;
  bool is_in_loop = false;
  const auto fail = [&](std::string_view problem) {
    throw Error(fmt::format("{}, after triangle {}, {}. Export the file again.", name, content.faces.size(), problem));
  };
  for (auto word = scanner.word(); !word.empty(); word = scanner.word()) {
    if (is_word(word, "vertex")) {
      glm::dvec3 corner;
      for (int axis = 0; axis < 3; ++axis) {
        const auto number = scanner.number();
        if (!number) fail("has a corner without three numbers");
        corner[axis] = *number;
      }
      if (++corners > 3) fail("has a facet with more than three corners");
      append_corner(content, corner);
      check_counts(content.vertices.size(), content.faces.size(), name);
    } else if (is_word(word, "loop")) {
      is_in_loop = true;
      corners = 0;
    } else if (is_word(word, "endloop")) {
      if (corners != 3) fail("has a facet with fewer than three corners");
      is_in_loop = false;
    } else if (is_word(word, "solid") || is_word(word, "endsolid")) {
      scanner.line();  // the name may contain any words
    }
  }
  if (is_in_loop) fail("ends in the middle of a facet, so the file is incomplete");
  return content;
}

}  // namespace

FileContent read_stl(std::span<const std::byte> file, const std::string& name) {
  const bool has_exact_size =
      file.size() >= header_bytes && file.size() == header_bytes + triangle_bytes * std::size_t{triangle_count(file)};
  if (!has_exact_size && is_ascii(file)) return read_ascii_stl(file, name);
  if (file.size() < header_bytes)
    throw Error(fmt::format("{} is neither an ASCII nor a binary STL file. Export the file again.", name));
  return read_binary_stl(file, name);
}

}  // namespace inkwell::importer
