// PLY files as programs write them.
#include <doctest/doctest.h>

#include <algorithm>

#include "host/import/error.hpp"
#include "host/import/readers.hpp"
#include "tests/failure.hpp"
#include "tests/host/import/made_files.hpp"

using namespace inkwell;
using namespace inkwell::tests;

namespace {

importer::FileContent read(const std::string& text) { return importer::read_ply(bytes_of(text), "cube.ply"); }

std::string refusal(const std::string& text) {
  return message_of<importer::Error>([&] { importer::check(read(text), "cube.ply"); });
}

const std::string header = "ply\nformat ascii 1.0\ncomment made by a test\n";
const std::string vertices_4 = "element vertex 4\nproperty float x\nproperty float y\nproperty float z\n";
const std::string points_4 = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n";

template <class Coordinate, class Index>
std::string binary_ply(bool is_big_endian, const std::string& coordinate, const std::string& index,
                       const std::string& line_end) {
  const Cube cube = make_cube(20);
  std::string text = "ply" + line_end;
  const auto add_line = [&](const std::string& line) { text += line + line_end; };
  add_line(std::string("format binary_") + (is_big_endian ? "big" : "little") + "_endian 1.0");
  add_line("element vertex 8");
  add_line("property uchar red");
  for (const char* axis : {"z", "x", "y"}) add_line("property " + coordinate + " " + axis);
  add_line("element face 12");
  add_line("property list uint8 float quality");
  add_line("property list uchar " + index + " vertex_index");
  add_line("property short flags");
  add_line("end_header");
  ByteText bytes(is_big_endian);
  for (const auto& vertex : cube.vertices) {
    bytes.add(std::uint8_t{10});  // a line feed as the first byte of the data
    for (const int axis : {2, 0, 1}) bytes.add(static_cast<Coordinate>(vertex[axis]));
  }
  for (const auto& face : cube.faces) {
    bytes.add(std::uint8_t{2}).add(0.5f).add(0.25f);
    bytes.add(std::uint8_t{3});
    for (const auto vertex : face) bytes.add(static_cast<Index>(vertex));
    bytes.add(std::int16_t{7});
  }
  return text + bytes.text;
}

void check_cube(const importer::FileContent& content) {
  const Cube cube = make_cube(20);
  REQUIRE(content.vertices.size() == 8);
  REQUIRE(content.faces.size() == 12);
  for (std::size_t i = 0; i < 8; ++i) CHECK(content.vertices[i] == glm::dvec3(cube.vertices[i]));
  CHECK(std::ranges::equal(content.faces, cube.faces));
}

}  // namespace

TEST_CASE("a binary PLY file is read in both byte orders, with all types, and with properties in any order") {
  for (const bool is_big_endian : {false, true})
    for (const std::string line_end : {"\n", "\r\n", "\r"}) {
      CAPTURE(is_big_endian);
      check_cube(read(binary_ply<float, std::int32_t>(is_big_endian, "float", "int", line_end)));
      check_cube(read(binary_ply<double, std::uint16_t>(is_big_endian, "float64", "ushort", line_end)));
      check_cube(read(binary_ply<std::int16_t, std::uint8_t>(is_big_endian, "short", "uint8", line_end)));
    }
}

TEST_CASE("elements of a PLY file may have any order and any names") {
  const auto content =
      read(header +
           "element camera 1\nproperty double focal_length\nproperty list int int rows\nelement face 1\n"
           "property list uchar int vertex_indices\n" +
           vertices_4 + "element empty 4000000000\nend_header\n1.5 2 7 8\n3 0 1 2\n" + points_4);
  CHECK(content.vertices.size() == 4);
  CHECK(content.faces.size() == 1);
}

TEST_CASE("polygons of a PLY file are split, also concave ones, and strips are unrolled") {
  const auto quad = read(header + vertices_4 + "element face 1\nproperty list uchar int vertex_indices\nend_header\n" +
                         points_4 + "4 0 1 2 3\n");
  CHECK(quad.faces.size() == 2);
  const auto strip =
      read(header + vertices_4 + "element tristrips 1\nproperty list int int vertex_indices\nend_header\n" + points_4 +
           "9 0 1 2 3 -1 2 1 0 -1\n");
  REQUIRE(strip.faces.size() == 3);
  CHECK(strip.faces[0] == geometry::Face{0, 1, 2});
  CHECK(strip.faces[1] == geometry::Face{2, 1, 3});
  CHECK(strip.faces[2] == geometry::Face{2, 1, 0});
}

TEST_CASE("an invalid PLY file is refused with a sentence") {
  const std::string face = "element face 1\nproperty list uchar int vertex_indices\nend_header\n";
  CHECK(contains(refusal("plyformat"), "the line \"ply\""));
  CHECK(contains(refusal("ply\nformat ascii 1.0\n"), "\"end_header\""));
  CHECK(contains(refusal("ply\nend_header\n"), "\"format\""));
  CHECK(contains(refusal("ply\nformat binary_middle_endian 1.0\n"), "binary_middle_endian"));
  CHECK(contains(refusal(header + "element vertex 3\nproperty complex x\n"), "unknown type \"complex\""));
  CHECK(contains(refusal(header + "element vertex many\n"), "without a valid count"));
  CHECK(contains(refusal(header + "property float x\n"), "before the first element"));
  CHECK(contains(refusal(header + "element vertex 1\nproperty float x\nproperty float y\nend_header\n1 2\n"),
                 "without the property \"z\""));
  CHECK(contains(refusal(header + vertices_4 + "end_header\n" + points_4), "points but no faces"));
  CHECK(contains(refusal(header + vertices_4 + face + points_4 + "3 0 1\n"), "incomplete or damaged"));
  CHECK(contains(refusal(header + vertices_4 + face + points_4 + "3 0 1 9\n"), "refers to vertex 10"));
  CHECK(contains(refusal(header + vertices_4 + face + points_4 + "4 0 1 2 9\n"), "refers to vertex 9"));
  CHECK(contains(refusal(header + vertices_4 + face + points_4 + "3 0 1 -7\n"), "vertex number -7"));
  CHECK(contains(refusal(header + vertices_4 + face + points_4 + "2000000 0 1 2\n"), "incomplete or damaged"));
  CHECK(
      contains(refusal(header + vertices_4 + face + "nan 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2\n"), "not a usable number"));
  const std::string huge =
      "ply\nformat binary_little_endian 1.0\nelement vertex 900000000\nproperty double x\nproperty double y\nproperty "
      "double z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n";
  CHECK(contains(refusal(huge + std::string(1000, 'x')), "do not fit into the file"));
}
