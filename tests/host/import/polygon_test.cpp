// Polygons as triangles.
#include <doctest/doctest.h>

#include <algorithm>
#include <numbers>
#include <numeric>
#include <random>

#include <glm/geometric.hpp>

#include "host/import/polygon.hpp"

using namespace inkwell;

namespace {

struct Area {
  double sum = 0;        ///< signed, along the normal of the polygon
  double magnitude = 0;  ///< equal to the sum only without overlaps
};

Area area_of(const std::vector<glm::dvec3>& polygon, const std::vector<geometry::Face>& faces) {
  glm::dvec3 normal(0);
  for (std::size_t i = 0; i < polygon.size(); ++i) normal += glm::cross(polygon[i], polygon[(i + 1) % polygon.size()]);
  normal = glm::normalize(normal);
  Area area;
  for (const auto& face : faces) {
    const double part =
        0.5 * glm::dot(normal, glm::cross(polygon[face[1]] - polygon[face[0]], polygon[face[2]] - polygon[face[0]]));
    area.sum += part;
    area.magnitude += std::abs(part);
  }
  return area;
}

std::vector<geometry::Face> split(const std::vector<glm::dvec3>& polygon) {
  std::vector<std::uint32_t> corners(polygon.size());
  std::iota(corners.begin(), corners.end(), 0u);
  std::vector<geometry::Face> faces;
  importer::append_triangles(polygon, corners, faces);
  return faces;
}

}  // namespace

TEST_CASE("a concave polygon is split without overlaps, from each first corner and on both sides") {
  const std::vector<glm::dvec3> arrow{{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {2, 1, 0}, {0, 4, 0}};
  for (std::size_t first = 0; first < arrow.size(); ++first)
    for (const bool is_reversed : {false, true}) {
      auto polygon = arrow;
      std::ranges::rotate(polygon, polygon.begin() + static_cast<std::ptrdiff_t>(first));
      if (is_reversed) std::ranges::reverse(polygon);
      const auto faces = split(polygon);
      CHECK(faces.size() == 3);
      CHECK(area_of(polygon, faces).sum == doctest::Approx(10));
      CHECK(area_of(polygon, faces).magnitude == doctest::Approx(10));
    }
}

TEST_CASE("stars in any plane are split without overlaps") {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> radius(0.2, 1);
  for (int repetition = 0; repetition < 50; ++repetition) {
    std::vector<glm::dvec3> polygon;
    double expected = 0;
    constexpr int corners = 40;
    std::vector<double> radii(corners);
    std::ranges::generate(radii, [&] { return radius(random); });
    for (int corner = 0; corner < corners; ++corner) {
      const double angle_rad = 2 * std::numbers::pi * corner / corners;
      const double x = radii[static_cast<std::size_t>(corner)] * std::cos(angle_rad);
      const double y = radii[static_cast<std::size_t>(corner)] * std::sin(angle_rad);
      polygon.emplace_back(x, 0.6 * y, 0.8 * y);
      expected += 0.5 * radii[static_cast<std::size_t>(corner)] *
                  radii[static_cast<std::size_t>((corner + 1) % corners)] * std::sin(2 * std::numbers::pi / corners);
    }
    const auto faces = split(polygon);
    CHECK(faces.size() == corners - 2);
    CHECK(area_of(polygon, faces).sum == doctest::Approx(expected));
    CHECK(area_of(polygon, faces).magnitude == doctest::Approx(expected));
  }
}

TEST_CASE("degenerate and crossing polygons result in triangles too") {
  CHECK(split({{0, 0, 0}, {1, 0, 0}}).empty());
  CHECK(split({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}}).size() == 2);
  CHECK(split({{0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}}).size() == 3);
  CHECK(split({{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 1, 0}}).size() == 2);
}
