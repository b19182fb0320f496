#include <doctest/doctest.h>

#include <filesystem>

#include <glm/geometric.hpp>

#include "host/feel/loading.hpp"
#include "host/geometry/examples.hpp"

#include "tests/host/import/made_files.hpp"
#include "tests/temporary_directory.hpp"

using namespace inkwell;
using namespace inkwell::tests;

namespace {

constexpr geometry::Box workspace{{-0.08f, -0.09f, -0.09f}, {0.08f, 0.09f, 0.04f}};

/// PLY file with a cube. Its sides have this length in the unit of the file.
std::filesystem::path write_cube(const TemporaryDirectory& directory, double side) {
  const Cube cube = make_cube(static_cast<float>(side));
  std::string text =
      "ply\nformat ascii 1.0\nelement vertex 8\nproperty float x\nproperty float y\nproperty float z\n"
      "element face 12\nproperty list uchar int vertex_indices\nend_header\n";
  for (const glm::vec3& vertex : cube.vertices)
    text += std::to_string(vertex.x) + " " + std::to_string(vertex.y) + " " + std::to_string(vertex.z) + "\n";
  for (const geometry::Face& face : cube.faces)
    text += "3 " + std::to_string(face[0]) + " " + std::to_string(face[1]) + " " + std::to_string(face[2]) + "\n";
  const std::filesystem::path file = directory.file("cube.ply");
  write_file(file, text);
  return file;
}

std::string problem_of(const feel::LoadRequest& request) {
  try {
    feel::load_object(request);
  } catch (const importer::Error& error) {
    return error.what();
  }
  return {};
}

}  // namespace

TEST_CASE("an object from a file is in the middle of the workspace, and its unit is stated") {
  const TemporaryDirectory directory;
  feel::LoadRequest request{.file = write_cube(directory, 40), .workspace = workspace};
  request.unit = importer::Unit::millimeter;
  const feel::LoadedObject loaded = feel::load_object(request);
  CHECK(loaded.name == "cube.ply");
  CHECK(loaded.unit_text == "mm, from --unit");
  CHECK(loaded.measurements.triangles == 12);
  CHECK(loaded.measurements.is_closed());
  const glm::dvec3 middle_m = loaded.placement.to_workspace(loaded.surface->middle_m());
  CHECK(glm::distance(middle_m, {0, 0, -0.025}) < 1e-6);
  CHECK(loaded.surface->radius_m() == doctest::Approx(0.02 * std::sqrt(3.0)).epsilon(1e-4));
}

TEST_CASE("an object that does not suit the workspace is refused with both remedies, and --fit accepts it") {
  const TemporaryDirectory directory;
  feel::LoadRequest request{.file = write_cube(directory, 1), .workspace = workspace};
  request.unit = importer::Unit::meter;
  const std::string problem = problem_of(request);
  CHECK(problem.find("1 m long") != std::string::npos);
  CHECK(problem.find("--scale 0.1") != std::string::npos);
  CHECK(problem.find("--fit") != std::string::npos);
  request.is_fit = true;
  const feel::LoadedObject loaded = feel::load_object(request);
  const glm::vec3 size_m = loaded.measurements.box.maximum_m - loaded.measurements.box.minimum_m;
  CHECK(size_m.x == doctest::Approx(0.8 * 0.13).epsilon(1e-4));  // the workspace is 130 mm high
  CHECK(loaded.remarks.back().find("0.104") != std::string::npos);
}

TEST_CASE("every example suits the workspace, and an unknown example lists the names") {
  for (const geometry::Example& example : geometry::examples()) {
    CAPTURE(std::string(example.name));
    const feel::LoadedObject loaded = feel::load_object({.example = std::string(example.name), .workspace = workspace});
    CHECK(loaded.measurements.is_closed());
    CHECK(loaded.surface->is_solid());
  }
  const std::string problem = problem_of({.example = "cheese", .workspace = workspace});
  CHECK(problem.find("There is no example cheese.") == 0);
  CHECK(problem.find("ball, cylinder, gear") != std::string::npos);
}

TEST_CASE("a worker thread loads the object, reports its progress, and can be canceled") {
  SUBCASE("loaded") {
    feel::Loading loading({.example = "ball", .workspace = workspace});
    const feel::LoadedObject loaded = loading.take();
    CHECK(loaded.name == "ball");
    CHECK(loading.progress() > 0.5);
    CHECK(loading.step() == "loading ball: building the search tree");
  }
  SUBCASE("canceled") {
    CHECK_THROWS_WITH_AS(feel::load_object({.example = "ball", .workspace = workspace}, [](double) { return false; }),
                         "The loading was canceled.", importer::Error);
  }
  SUBCASE("missing file") {
    feel::Loading loading({.file = "/nowhere/skull.stl", .workspace = workspace});
    CHECK_THROWS_AS(loading.take(), importer::Error);
    CHECK(loading.step() == "loading skull.stl: reading the mesh");
  }
}
