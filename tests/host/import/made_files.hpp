// Object files that the tests write.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <glm/vec3.hpp>

#include "host/geometry/mesh.hpp"

namespace inkwell::tests {

/// Little-endian or big-endian bytes of values.
class ByteText {
 public:
  explicit ByteText(bool is_big_endian = false) : is_big_endian_(is_big_endian) {}

  template <class Value>
  ByteText& add(Value value) {
    std::array<char, sizeof value> raw{};
    std::memcpy(raw.data(), &value, sizeof value);
    if (is_big_endian_) std::reverse(raw.begin(), raw.end());
    text.append(raw.data(), raw.size());
    return *this;
  }

  std::string text{};

 private:
  bool is_big_endian_;
};

inline std::span<const std::byte> bytes_of(std::string_view text) { return std::as_bytes(std::span(text)); }

inline void write_file(const std::filesystem::path& file, std::string_view content) {
  std::ofstream(file, std::ios::binary).write(content.data(), static_cast<std::streamsize>(content.size()));
}

/// A cube with its minimum at the origin and 12 outward triangles.
struct Cube {
  std::vector<glm::vec3> vertices{};
  std::vector<geometry::Face> faces{};
};

inline Cube make_cube(float side = 1) {
  Cube cube;
  for (int corner = 0; corner < 8; ++corner)
    cube.vertices.push_back(side * glm::vec3(static_cast<float>(corner & 1), static_cast<float>(corner / 2 & 1),
                                             static_cast<float>(corner / 4)));
  constexpr std::array<std::array<std::uint32_t, 4>, 6> walls{
      {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}};
  for (const auto& wall : walls) {
    cube.faces.push_back({wall[0], wall[1], wall[2]});
    cube.faces.push_back({wall[0], wall[2], wall[3]});
  }
  return cube;
}

/// A binary STL file. `header`: at most 80 bytes.
inline std::string binary_stl(const Cube& cube, std::string header = "made by a test") {
  header.resize(80, ' ');
  ByteText bytes;
  bytes.text = header;
  bytes.add(static_cast<std::uint32_t>(cube.faces.size()));
  for (const auto& face : cube.faces) {
    for (int i = 0; i < 3; ++i) bytes.add(0.0f);
    for (const auto vertex : face)
      for (int axis = 0; axis < 3; ++axis) bytes.add(cube.vertices[vertex][axis]);
    bytes.add(std::uint16_t{0});
  }
  return bytes.text;
}

inline std::string ascii_stl(const Cube& cube, std::string_view line_end = "\n") {
  std::string text = "solid a facet name";
  const auto add_line = [&](const std::string& line) { (text += line_end) += line; };
  for (const auto& face : cube.faces) {
    add_line("  facet normal 0 0 0");
    add_line("    outer loop");
    for (const auto vertex : face) {
      std::string line = "      vertex";
      for (int axis = 0; axis < 3; ++axis) line += " " + std::to_string(cube.vertices[vertex][axis]);
      add_line(line);
    }
    add_line("    endloop");
    add_line("  endfacet");
  }
  add_line("endsolid a facet name");
  return text + std::string(line_end);
}

}  // namespace inkwell::tests
