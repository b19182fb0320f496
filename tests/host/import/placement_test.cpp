// Units, sizes and positions of objects.
#include <doctest/doctest.h>

#include "host/import/format.hpp"
#include "host/import/placement.hpp"
#include "host/import/unit.hpp"
#include "tests/failure.hpp"
#include "tests/host/import/made_files.hpp"

using namespace inkwell;
using namespace inkwell::importer;
using tests::contains;

namespace {

const geometry::Box workspace{{-0.08f, -0.09f, -0.09f}, {0.05f, 0.09f, 0.09f}};

geometry::Box cube_of(float side_m) { return {glm::vec3(1), glm::vec3(1 + side_m)}; }

}  // namespace

TEST_CASE("the proposed unit makes an object touchable, and prefers millimeters") {
  CHECK(propose_unit(180) == Unit::millimeter);
  CHECK(propose_unit(20) == Unit::millimeter);
  CHECK(propose_unit(0.18) == Unit::meter);
  CHECK(propose_unit(2) == Unit::centimeter);
  CHECK(propose_unit(1500) == Unit::millimeter);
  CHECK(propose_unit(0.005) == Unit::meter);
  CHECK(propose_unit(1e7) == Unit::millimeter);
  CHECK(propose_unit(1e-7) == Unit::meter);
  for (const Unit unit : all_units) CHECK(parse_unit(symbol_of(unit)) == unit);
  CHECK_FALSE(parse_unit("furlong").has_value());
  CHECK(meters_per(Unit::inch) == 0.0254);
}

TEST_CASE("lengths have a suitable unit") {
  CHECK(length_text(80) == "80 m");
  CHECK(length_text(0.0804) == "80.4 mm");
  CHECK(length_text(2e-5) == "20 um");
  CHECK(length_text(0) == "0 m");
}

TEST_CASE("an object is fitted to the workspace, with space around it") {
  const geometry::Box plate{{0, 0, 0}, {1, 40, 2}};
  const Placement placement = fit_to_workspace(plate, workspace);
  CHECK(placement.scale == doctest::Approx(0.8 * 0.18 / 40));
  geometry::Mesh mesh{{{0, 0, 0}, {1, 40, 2}}, {}};
  apply(placement, mesh);
  CHECK(mesh.vertices_m[0].y == doctest::Approx(-0.072));
  CHECK(mesh.vertices_m[1].y == doctest::Approx(0.072));
  CHECK(mesh.vertices_m[0].x + mesh.vertices_m[1].x == doctest::Approx(-0.03));
  CHECK(fit_to_workspace({glm::vec3(1), glm::vec3(1)}, workspace).scale == 1);
}

TEST_CASE("an object is dropped to the origin") {
  const Placement placement = drop_to_origin({{1, 2, 3}, {3, 6, 9}});
  CHECK(placement.scale == 1);
  CHECK(placement.offset_m == glm::dvec3(-2, -4, -6));
}

TEST_CASE("an object of unsuitable size gets a remark with a scale") {
  CHECK(size_remark(cube_of(0.1f), workspace).empty());
  CHECK(propose_scale(cube_of(0.1f), workspace) == 1);
  const auto large = size_remark(cube_of(80), workspace);
  CHECK(contains(large, "The object is 80 m long, 615 times too large for the workspace of 130 mm x 180 mm x 180 mm."));
  CHECK(contains(large, "--scale 0.001"));
  CHECK(propose_scale(cube_of(80), workspace) == doctest::Approx(0.001));
  CHECK(contains(size_remark(cube_of(1e-4f), workspace), "only 100 um long"));
  CHECK(propose_scale(cube_of(1e-4f), workspace) == doctest::Approx(1000));
  CHECK(size_remark(cube_of(0), workspace).empty());
}

TEST_CASE("the signature of a file decides its format, and then its extension") {
  const auto format = [](const char* name, std::string_view begin) {
    return detect_format(name, tests::bytes_of(begin));
  };
  CHECK(format("a.txt", "ply\nformat") == Format::ply);
  CHECK(format("a.stl", "ply\r\nformat") == Format::ply);
  CHECK(format("a", "glTF\2") == Format::gltf);
  CHECK(format("a.txt", "\xEF\xBB\xBF#VRML V2.0 utf8") == Format::vrml);
  CHECK(format("A.STL", "solid") == Format::stl);
  CHECK(format("a.Obj", "v 0 0 0") == Format::obj);
  CHECK(format("a.gltf", "{") == Format::gltf);
  CHECK(format("a.wrl", "\x1F\x8B") == Format::vrml);
  CHECK(format("a.WRL.GZ", "\x1F\x8B") == Format::vrml);
  CHECK_FALSE(format("a.stl.gz", "\x1F\x8B").has_value());
  CHECK_FALSE(format("a.png", "\x89PNG").has_value());
  CHECK_FALSE(format("plywood", "plywood").has_value());
  for (const Format each : {Format::stl, Format::ply, Format::obj, Format::gltf, Format::vrml})
    CHECK(parse_format(key_of(each)) == each);
}
