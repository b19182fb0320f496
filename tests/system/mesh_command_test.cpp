// `inkwell mesh` for people and for programs.
#include <doctest/doctest.h>

#include <nlohmann/json.hpp>

#include "tests/failure.hpp"
#include "tests/host/import/made_files.hpp"
#include "tests/system/program.hpp"

using namespace inkwell;
using namespace inkwell::tests;

TEST_CASE("inkwell mesh prints size, parts, repairs and advice") {
  const TemporaryDirectory directory;
  Cube cube = make_cube(20);
  std::swap(cube.faces[3][0], cube.faces[3][1]);
  write_file(directory / "cube.stl", binary_stl(cube));
  const auto printed = run_program("inkwell", {"mesh", directory.file("cube.stl")});
  CHECK(printed.exit_code == 0);
  CHECK(printed.err.empty());
  for (const char* words : {"file                cube.stl, STL\n", "unit                mm, assumed\n",
                            "triangles           12, with 8 vertices\n", "parts               1 part, closed\n",
                            "box                 20 mm x 20 mm x 20 mm\n", "area                24 cm2\n",
                            "volume              8 cm3\n", "1 flipped triangle was turned.\n"}) {
    CAPTURE(words);
    CHECK(contains(printed.out, words));
  }
  const auto large = run_program("inkwell", {"mesh", directory.file("cube.stl"), "--unit", "m"});
  CHECK(contains(large.out, "times too large for the workspace of 160 mm x 180 mm x 130 mm. Use --scale 0.005."));
}

TEST_CASE("inkwell mesh --json has the same figures") {
  const TemporaryDirectory directory;
  Cube cube = make_cube(20);
  cube.faces.pop_back();
  cube.faces.push_back({5, 5, 6});
  write_file(directory / "open.stl", binary_stl(cube));
  const auto printed =
      run_program("inkwell", {"mesh", directory.file("open.stl"), "--unit", "mm", "--scale", "2", "--json"});
  REQUIRE(printed.exit_code == 0);
  const auto json = nlohmann::json::parse(printed.out);
  CHECK(json["triangles"] == 11);
  CHECK(json["closed"] == false);
  CHECK(json["open_edges"] == 3);
  CHECK(json["unit"] == "mm");
  CHECK(json["unit_source"] == "from --unit");
  CHECK(json["repairs"]["degenerate"] == 1);
  CHECK(json["box_maximum_m"][1].get<double>() == doctest::Approx(0.04));
  CHECK(json["box_minimum_m"][1].get<double>() == doctest::Approx(0));
}

TEST_CASE("inkwell mesh refuses files and options with a sentence") {
  const TemporaryDirectory directory;
  write_file(directory / "note.txt", "This is not an object.");
  const auto text = run_program("inkwell", {"mesh", directory.file("note.txt")});
  CHECK(text.exit_code == 1);
  CHECK(contains(text.err, "note.txt has an unknown format. Export the object as one of .stl, .obj"));
  CHECK(contains(run_program("inkwell", {"mesh", directory.file("none.stl")}).err, "none.stl cannot be opened"));
  CHECK(run_program("inkwell", {"mesh", directory.file("none.stl"), "--unit", "furlong"}).exit_code == 2);
  CHECK(run_program("inkwell", {"mesh", directory.file("none.stl"), "--scale", "0"}).exit_code == 2);
  CHECK(run_program("inkwell", {"mesh"}).exit_code == 2);
}
