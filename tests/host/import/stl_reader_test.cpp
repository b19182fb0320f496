// STL files as programs write them.
#include <doctest/doctest.h>

#include <algorithm>
#include <limits>

#include "host/import/error.hpp"
#include "host/import/readers.hpp"
#include "tests/failure.hpp"
#include "tests/host/import/made_files.hpp"

using namespace inkwell;
using namespace inkwell::tests;

namespace {

importer::FileContent read(const std::string& text) { return importer::read_stl(bytes_of(text), "cube.stl"); }

std::string refusal(const std::string& text) {
  return message_of<importer::Error>([&] { importer::check(read(text), "cube.stl"); });
}

}  // namespace

TEST_CASE("a binary STL file is read, whatever its header says and whatever follows its triangles") {
  const Cube cube = make_cube(20);
  for (const std::string header : {"made by a test", "solid cube", "solid facet normal"}) {
    for (const std::size_t appended : {0u, 10u, 1000u}) {
      CAPTURE(header);
      CAPTURE(appended);
      const auto content = read(binary_stl(cube, header) + std::string(appended, '\0'));
      REQUIRE(content.faces.size() == 12);
      for (std::size_t face = 0; face < 12; ++face)
        for (std::size_t corner = 0; corner < 3; ++corner)
          CHECK(content.vertices[content.faces[face][corner]] == glm::dvec3(cube.vertices[cube.faces[face][corner]]));
    }
  }
}

TEST_CASE("an ASCII STL file is read with all line ends, in upper case, and with several solids") {
  const std::string text = ascii_stl(make_cube(20));
  CHECK(read(text).faces.size() == 12);
  CHECK(read(ascii_stl(make_cube(20), "\r\n")).faces.size() == 12);
  CHECK(read(ascii_stl(make_cube(20), "\r")).faces.size() == 12);
  CHECK(read("\xEF\xBB\xBF" + text).faces.size() == 12);
  CHECK(read("  " + text + text).faces.size() == 24);
  std::string upper = text;
  std::ranges::transform(upper, upper.begin(), [](char c) { return static_cast<char>(std::toupper(c)); });
  CHECK(read(upper).faces.size() == 12);
  const auto numbers = read(
      "solid\nfacet normal 0 0 1\nouter loop\nvertex +1.5e1 -.25 3\nvertex 1E-3 2. 0\nvertex 0 0 0\nendloop\nendfacet\n"
      "endsolid\n");
  CHECK(numbers.vertices[0] == glm::dvec3(15, -0.25, 3));
  CHECK(numbers.vertices[1] == glm::dvec3(0.001, 2, 0));
}

TEST_CASE("an invalid STL file is refused with a sentence") {
  const Cube cube = make_cube();
  const std::string binary = binary_stl(cube), ascii = ascii_stl(cube);
  CHECK(contains(refusal(binary.substr(0, 300)), "announces 12 triangles but contains only 4"));
  CHECK(contains(refusal(binary.substr(0, 50)), "neither an ASCII nor a binary STL file"));
  CHECK(contains(refusal(binary_stl({})), "contains no triangles"));
  CHECK(contains(refusal("solid nothing\nendsolid nothing\n"), "contains no triangles"));
  CHECK(contains(refusal(ascii.substr(0, ascii.find("endloop"))), "the file is incomplete"));
  CHECK(contains(refusal("solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 zero\n"), "three numbers"));
  CHECK(contains(refusal("solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nendloop\nendfacet\n"),
                 "fewer than three corners"));
  std::string many = binary;
  const std::uint32_t two_hundred_million = 200'000'000;
  std::memcpy(many.data() + 80, &two_hundred_million, sizeof two_hundred_million);
  CHECK(contains(refusal(many), "announces 200000000 triangles but contains only 12"));
  for (const float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(), 1e30f}) {
    Cube damaged = cube;
    damaged.vertices[3].y = bad;
    CHECK(contains(refusal(binary_stl(damaged)), "not a usable number"));
  }
}
