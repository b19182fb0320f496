#include "host/geometry/examples.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include <glm/geometric.hpp>

namespace inkwell::geometry {
namespace {

constexpr double pi = std::numbers::pi;

glm::dvec2 at_angle(double angle_rad, double radius_m) {
  return glm::dvec2{std::cos(angle_rad), std::sin(angle_rad)} * radius_m;
}

Outline circle(double radius_m, unsigned corners) {
  Outline outline_m;
  for (unsigned corner = 0; corner < corners; ++corner)
    outline_m.push_back(at_angle(2 * pi * corner / corners, radius_m));
  return outline_m;
}

double cross(const glm::dvec2& left, const glm::dvec2& right) { return left.x * right.y - left.y * right.x; }

/// True if the triangle of three corners is convex and contains no other corner.
bool is_ear(const Outline& outline_m, const std::vector<std::uint32_t>& left, std::size_t index) {
  const std::size_t count = left.size();
  const std::array<std::uint32_t, 3> corners{left[(index + count - 1) % count], left[index], left[(index + 1) % count]};
  const glm::dvec2& a_m = outline_m[corners[0]];
  const glm::dvec2& b_m = outline_m[corners[1]];
  const glm::dvec2& c_m = outline_m[corners[2]];
  if (cross(b_m - a_m, c_m - b_m) <= 0) return false;
  return std::ranges::none_of(left, [&](std::uint32_t corner) {
    if (std::ranges::find(corners, corner) != corners.end()) return false;
    const glm::dvec2& point_m = outline_m[corner];
    return cross(b_m - a_m, point_m - a_m) >= 0 && cross(c_m - b_m, point_m - b_m) >= 0 &&
           cross(a_m - c_m, point_m - c_m) >= 0;
  });
}

/// Triangles of a polygon, by cutting off ears.
std::vector<Face> triangulate(const Outline& outline_m) {
  std::vector<std::uint32_t> left(outline_m.size());
  for (std::size_t index = 0; index < left.size(); ++index) left[index] = static_cast<std::uint32_t>(index);
  std::vector<Face> faces;
  while (left.size() > 3) {
    std::size_t ear = 0;
    while (ear + 1 < left.size() && !is_ear(outline_m, left, ear)) ++ear;
    const std::size_t count = left.size();
    faces.push_back({left[(ear + count - 1) % count], left[ear], left[(ear + 1) % count]});
    left.erase(left.begin() + static_cast<std::ptrdiff_t>(ear));
  }
  faces.push_back({left[0], left[1], left[2]});
  return faces;
}

void add_quad(Mesh& mesh, std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
  mesh.faces.push_back({a, b, c});
  mesh.faces.push_back({a, c, d});
}

/// Two copies of the outline: corner i becomes the vertices first + 2 i (bottom) and first + 2 i + 1 (top).
void add_corners(Mesh& mesh, const Outline& outline_m, double height_m) {
  for (const glm::dvec2& corner_m : outline_m)
    for (const double z_m : {-height_m / 2, height_m / 2})
      mesh.vertices_m.push_back(glm::vec3{glm::dvec3{corner_m.x, corner_m.y, z_m}});
}

/// Smooth minimum: the bodies blend within `blend_m`.
double blend(double left_m, double right_m, double blend_m) {
  const double part = std::clamp(0.5 + 0.5 * (right_m - left_m) / blend_m, 0.0, 1.0);
  return right_m + (left_m - right_m) * part - blend_m * part * (1 - part);
}

double carve(double body_m, double hole_m, double blend_m) { return -blend(-body_m, hole_m, blend_m); }

double ellipsoid_m(const glm::dvec3& point_m, const glm::dvec3& center_m, const glm::dvec3& size_m) {
  const glm::dvec3 scaled = (point_m - center_m) / size_m;
  return (glm::length(scaled) - 1) * std::min({size_m.x, size_m.y, size_m.z});
}

/// A skull of ellipsoids, facing +z, with y upward.
double skull_m(const glm::dvec3& point_m) {
  const glm::dvec3 half_m{std::abs(point_m.x), point_m.y, point_m.z};
  double body_m = ellipsoid_m(half_m, {0, 0.012, -0.006}, {0.029, 0.028, 0.034});                       // cranium
  body_m = blend(body_m, ellipsoid_m(half_m, {0, -0.012, 0.013}, {0.019, 0.020, 0.013}), 0.006);        // face
  body_m = blend(body_m, ellipsoid_m(half_m, {0.017, -0.006, 0.014}, {0.010, 0.006, 0.010}), 0.004);    // cheekbones
  body_m = blend(body_m, ellipsoid_m(half_m, {0, -0.031, 0.015}, {0.015, 0.008, 0.012}), 0.003);        // lower jaw
  body_m = blend(body_m, ellipsoid_m(half_m, {0.0175, -0.021, 0.003}, {0.005, 0.012, 0.009}), 0.005);   // jaw angles
  body_m = carve(body_m, ellipsoid_m(half_m, {0.0105, 0.001, 0.029}, {0.0075, 0.0068, 0.013}), 0.003);  // eye sockets
  body_m = carve(body_m, ellipsoid_m(half_m, {0, -0.011, 0.027}, {0.0034, 0.0062, 0.007}), 0.002);      // nose
  body_m = carve(body_m, ellipsoid_m(half_m, {0, -0.0238, 0.030}, {0.013, 0.0012, 0.008}), 0.001);      // mouth
  const double teeth_m = 0.0004 * std::cos(half_m.x * 1700) * std::exp(-std::pow((half_m.y + 0.0238) / 0.004, 2.0)) *
                         std::clamp((half_m.z - 0.012) / 0.005, 0.0, 1.0);
  return body_m - teeth_m;
}

Mesh make_stairs() {
  constexpr int steps = 6;
  constexpr double tread_m = 0.012;
  constexpr double riser_m = 0.008;
  Outline outline_m{{-steps * tread_m / 2, -0.03}, {steps * tread_m / 2, -0.03}};
  for (int number = steps; number > 0; --number) {
    const double top_m = -0.03 + number * riser_m;
    outline_m.push_back({(number - steps / 2) * tread_m, top_m});
    outline_m.push_back({(number - 1 - steps / 2) * tread_m, top_m});
  }
  return extrude(outline_m, 0.06);
}

Mesh make_gear() {
  constexpr unsigned teeth = 16;
  constexpr unsigned points = 8;
  constexpr std::array<double, points> radii_m{0.028, 0.028, 0.028, 0.030, 0.034, 0.034, 0.034, 0.030};
  Outline outer_m;
  for (unsigned point = 0; point < teeth * points; ++point)
    outer_m.push_back(at_angle(2 * pi * point / (teeth * points), radii_m[point % points]));
  return extrude_ring(outer_m, circle(0.010, teeth * points), 0.015);
}

Mesh make_slit() {
  constexpr double half_gap_m = 0.0012;
  return extrude({{-0.03, -0.02},
                  {0.03, -0.02},
                  {0.03, 0.02},
                  {half_gap_m, 0.02},
                  {half_gap_m, -0.01},
                  {-half_gap_m, -0.01},
                  {-half_gap_m, 0.02},
                  {-0.03, 0.02}},
                 0.04);
}

constexpr std::array<Example, 9> list = {{
    {"ball", "ball with gentle waves", [] { return make_ball(0.035, 0.0015, 6); }},
    {"cylinder", "standing cylinder", [] { return make_cylinder(0.025, 0.06, 128); }},
    {"gear", "gear wheel with 16 teeth and a hole", make_gear},
    {"plate", "plate of 0.2 mm thickness",
     [] {
       return make_box({0.07, 0.05, 0.0002});
     }},
    {"skull", "small skull", [] { return make_implicit(skull_m, 0.05, 96); }},
    {"slit", "block with a slit of 2.4 mm", make_slit},
    {"stairs", "six stairs", make_stairs},
    {"star", "star with sharp ridges and grooves",
     [] {
       Outline outline_m;
       for (unsigned corner = 0; corner < 16; ++corner)
         outline_m.push_back(at_angle(2 * pi * corner / 16, corner % 2 == 0 ? 0.035 : 0.015));
       return extrude(outline_m, 0.02);
     }},
    {"torus", "ring with a round section", [] { return make_torus(0.025, 0.009, 128, 48); }},
}};

}  // namespace

std::span<const Example> examples() { return list; }

Mesh make_ball(double radius_m, double bumps_m, unsigned subdivisions) {
  const double golden = (1 + std::sqrt(5.0)) / 2;
  std::vector<glm::dvec3> directions;
  for (const double one : {-1.0, 1.0})
    for (const double other : {-golden, golden}) {
      directions.push_back(glm::normalize(glm::dvec3{0, one, other}));
      directions.push_back(glm::normalize(glm::dvec3{one, other, 0}));
      directions.push_back(glm::normalize(glm::dvec3{other, 0, one}));
    }
  // The faces of the icosahedron are the triples of nearest corners.
  std::vector<Face> faces;
  const auto is_edge_of = [&](std::uint32_t left, std::uint32_t right) {
    return glm::distance(directions[left], directions[right]) < 1.1;
  };
  for (std::uint32_t a = 0; a < 12; ++a)
    for (std::uint32_t b = a + 1; b < 12; ++b)
      for (std::uint32_t c = b + 1; c < 12; ++c) {
        if (!is_edge_of(a, b) || !is_edge_of(b, c) || !is_edge_of(c, a)) continue;
        const bool is_outward = glm::dot(directions[a], glm::cross(directions[b], directions[c])) > 0;
        faces.push_back(is_outward ? Face{a, b, c} : Face{a, c, b});
      }
  for (unsigned subdivision = 0; subdivision < subdivisions; ++subdivision) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
    const auto middle = [&](std::uint32_t left, std::uint32_t right) {
      const auto [entry, is_new] =
          middles.try_emplace(std::minmax(left, right), static_cast<std::uint32_t>(directions.size()));
      if (is_new) directions.push_back(glm::normalize(directions[left] + directions[right]));
      return entry->second;
    };
    std::vector<Face> finer;
    finer.reserve(4 * faces.size());
    for (const auto& [a, b, c] : faces) {
      const std::uint32_t ab = middle(a, b);
      const std::uint32_t bc = middle(b, c);
      const std::uint32_t ca = middle(c, a);
      for (const Face& face : {Face{a, ab, ca}, Face{b, bc, ab}, Face{c, ca, bc}, Face{ab, bc, ca}})
        finer.push_back(face);
    }
    faces = std::move(finer);
  }
  Mesh mesh;
  for (const glm::dvec3& direction : directions) {
    const double wave = std::sin(9 * direction.x + 1) * std::sin(8 * direction.y + 2) * std::sin(10 * direction.z + 3);
    mesh.vertices_m.push_back(glm::vec3{direction * (radius_m + bumps_m * wave)});
  }
  mesh.faces = std::move(faces);
  return mesh;
}

Mesh make_torus(double radius_m, double tube_radius_m, unsigned around, unsigned around_tube) {
  Mesh mesh;
  for (unsigned step = 0; step < around; ++step)
    for (unsigned tube_step = 0; tube_step < around_tube; ++tube_step) {
      const glm::dvec2 section_m = at_angle(2 * pi * tube_step / around_tube, tube_radius_m);
      const glm::dvec2 along_m = at_angle(2 * pi * step / around, radius_m + section_m.x);
      mesh.vertices_m.push_back(glm::vec3{glm::dvec3{along_m.x, along_m.y, section_m.y}});
    }
  const auto index = [&](unsigned step, unsigned tube_step) {
    return (step % around) * around_tube + tube_step % around_tube;
  };
  for (unsigned step = 0; step < around; ++step)
    for (unsigned tube_step = 0; tube_step < around_tube; ++tube_step)
      add_quad(mesh, index(step, tube_step), index(step + 1, tube_step), index(step + 1, tube_step + 1),
               index(step, tube_step + 1));
  return mesh;
}

Mesh make_cylinder(double radius_m, double height_m, unsigned around) {
  return extrude(circle(radius_m, around), height_m);
}

Mesh make_box(const glm::dvec3& size_m) {
  const glm::dvec2 half_m{size_m.x / 2, size_m.y / 2};
  return extrude({-half_m, {half_m.x, -half_m.y}, half_m, {-half_m.x, half_m.y}}, size_m.z);
}

Mesh extrude(const Outline& outline_m, double height_m) {
  Mesh mesh;
  add_corners(mesh, outline_m, height_m);
  for (const auto& [a, b, c] : triangulate(outline_m)) {
    mesh.faces.push_back({2 * a, 2 * c, 2 * b});
    mesh.faces.push_back({2 * a + 1, 2 * b + 1, 2 * c + 1});
  }
  const auto count = static_cast<std::uint32_t>(outline_m.size());
  for (std::uint32_t corner = 0; corner < count; ++corner) {
    const std::uint32_t next = (corner + 1) % count;
    add_quad(mesh, 2 * corner, 2 * next, 2 * next + 1, 2 * corner + 1);
  }
  return mesh;
}

Mesh extrude_ring(const Outline& outer_m, const Outline& inner_m, double height_m) {
  Mesh mesh;
  add_corners(mesh, outer_m, height_m);
  add_corners(mesh, inner_m, height_m);
  const auto count = static_cast<std::uint32_t>(std::min(outer_m.size(), inner_m.size()));
  const auto inner = static_cast<std::uint32_t>(2 * outer_m.size());
  for (std::uint32_t corner = 0; corner < count; ++corner) {
    const std::uint32_t here = 2 * corner;
    const std::uint32_t next = 2 * ((corner + 1) % count);
    add_quad(mesh, here, next, next + 1, here + 1);
    add_quad(mesh, inner + next, inner + here, inner + here + 1, inner + next + 1);
    add_quad(mesh, here + 1, next + 1, inner + next + 1, inner + here + 1);
    add_quad(mesh, next, here, inner + here, inner + next);
  }
  return mesh;
}

Mesh make_implicit(const std::function<double(const glm::dvec3& point_m)>& distance_m, double half_size_m,
                   unsigned cells) {
  const unsigned points = cells + 1;
  const auto position_m = [&](std::uint32_t point) {
    const glm::dvec3 index{point % points, point / points % points, point / points / points};
    return (index / static_cast<double>(cells) * 2.0 - 1.0) * half_size_m;
  };
  std::vector<double> values_m(static_cast<std::size_t>(points) * points * points);
  for (std::uint32_t point = 0; point < values_m.size(); ++point) values_m[point] = distance_m(position_m(point));

  Mesh mesh;
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> crossings;
  const auto crossing = [&](std::uint32_t inside, std::uint32_t outside) {
    const auto [entry, is_new] =
        crossings.try_emplace(std::minmax(inside, outside), static_cast<std::uint32_t>(mesh.vertices_m.size()));
    if (is_new) {
      // Crossings stay away from grid points, so that no triangle loses its area.
      const double part = std::clamp(values_m[inside] / (values_m[inside] - values_m[outside]), 0.05, 0.95);
      mesh.vertices_m.push_back(glm::vec3{position_m(inside) * (1 - part) + position_m(outside) * part});
    }
    return entry->second;
  };
  // Six tetrahedra of a cube share its diagonal. Each has the same orientation.
  constexpr std::array<std::array<unsigned, 4>, 6> tetrahedra = {
      {{0, 1, 3, 7}, {0, 3, 2, 7}, {0, 2, 6, 7}, {0, 6, 4, 7}, {0, 4, 5, 7}, {0, 5, 1, 7}}};
  for (std::uint32_t cell = 0; cell < cells * cells * cells; ++cell) {
    const std::uint32_t corner = cell % cells + points * (cell / cells % cells + points * (cell / cells / cells));
    for (const auto& tetrahedron : tetrahedra) {
      std::array<std::uint32_t, 4> order;
      std::array<bool, 4> is_inside{};
      for (std::size_t index = 0; index < 4; ++index) {
        const unsigned bits = tetrahedron[index];
        order[index] = corner + (bits & 1) + points * ((bits >> 1 & 1) + points * (bits >> 2));
        is_inside[index] = values_m[order[index]] < 0;
      }
      const auto inside_count = std::ranges::count(is_inside, true);
      if (inside_count == 0 || inside_count == 4) continue;
      // Even permutations preserve the orientation: the odd ones of out bring the inner corners to the front.
      const auto swap = [&](std::size_t left, std::size_t right) {
        std::swap(order[left], order[right]);
        std::swap(is_inside[left], is_inside[right]);
      };
      bool is_mirrored = false;
      for (std::size_t front = 0; front < 4; ++front)
        for (std::size_t index = front + 1; index < 4; ++index)
          if (!is_inside[front] && is_inside[index]) {
            swap(front, index);
            is_mirrored = !is_mirrored;
          }
      const auto& [a, b, c, d] = order;
      const auto add = [&](std::uint32_t first, std::uint32_t second, std::uint32_t third) {
        mesh.faces.push_back(is_mirrored ? Face{first, third, second} : Face{first, second, third});
      };
      if (inside_count == 1) {
        add(crossing(a, b), crossing(a, c), crossing(a, d));
      } else if (inside_count == 2) {
        add(crossing(a, c), crossing(a, d), crossing(b, d));
        add(crossing(a, c), crossing(b, d), crossing(b, c));
      } else {
        add(crossing(a, d), crossing(b, d), crossing(c, d));
      }
    }
  }
  return mesh;
}

}  // namespace inkwell::geometry
