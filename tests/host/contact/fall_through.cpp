#include "tests/host/contact/fall_through.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include "host/contact/step.hpp"
#include "host/geometry/examples.hpp"

namespace inkwell::contact_trial {
namespace {

using geometry::Mesh;
using geometry::Outline;

/// Longest permitted approach of the tip: two thousandths of a millimeter.
constexpr double tolerance_m = 2e-6;
/// The tip starts farther from the wall than the facets of the ball are from the sphere.
constexpr double start_clearance_m = 1e-4;

void append_inverted(Mesh& mesh, const Mesh& inner) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices_m.size());
  mesh.vertices_m.insert(mesh.vertices_m.end(), inner.vertices_m.begin(), inner.vertices_m.end());
  for (const auto& [a, b, c] : inner.faces) mesh.faces.push_back({first + a, first + c, first + b});
}

/// Signed distance from a polygon, negative inside.
double distance_from_outline_m(const Outline& outline_m, const glm::dvec2& point_m) {
  double least_m = 1;
  bool is_inside = false;
  for (std::size_t index = 0; index < outline_m.size(); ++index) {
    const glm::dvec2& start_m = outline_m[index];
    const glm::dvec2& end_m = outline_m[(index + 1) % outline_m.size()];
    const glm::dvec2 along_m = end_m - start_m;
    const double part = std::clamp(glm::dot(point_m - start_m, along_m) / glm::dot(along_m, along_m), 0.0, 1.0);
    least_m = std::min(least_m, glm::distance(point_m, start_m + along_m * part));
    if ((start_m.y > point_m.y) != (end_m.y > point_m.y) &&
        point_m.x < start_m.x + along_m.x * (point_m.y - start_m.y) / along_m.y)
      is_inside = !is_inside;
  }
  return is_inside ? -least_m : least_m;
}

/// Signed distance from a prism, negative inside.
double distance_from_prism_m(const Outline& outline_m, double height_m, const glm::dvec3& point_m) {
  const double beside_m = distance_from_outline_m(outline_m, {point_m.x, point_m.y});
  const double above_m = std::abs(point_m.z) - height_m / 2;
  return beside_m > 0 && above_m > 0 ? std::hypot(beside_m, above_m) : std::max(beside_m, above_m);
}

HollowBody hollow_prism(std::string name, const Outline& outer_m, const Outline& inner_m, double height_m,
                        double wall_m) {
  Mesh mesh = geometry::extrude(outer_m, height_m);
  append_inverted(mesh, geometry::extrude(inner_m, height_m - 2 * wall_m));
  return {std::move(name), geometry::Surface::build(geometry::weld(mesh.vertices_m, mesh.faces)), 0.04,
          [=](const glm::dvec3& point_m) { return distance_from_prism_m(outer_m, height_m, point_m); },
          [=](const glm::dvec3& point_m) { return -distance_from_prism_m(inner_m, height_m - 2 * wall_m, point_m); }};
}

Outline scaled(Outline outline_m, double factor) {
  for (glm::dvec2& corner_m : outline_m) corner_m *= factor;
  return outline_m;
}

HollowBody hollow_ball() {
  constexpr double radius_m = 0.02;
  constexpr double wall_m = 0.0002;
  Mesh mesh = geometry::make_ball(radius_m, 0, 4);
  append_inverted(mesh, geometry::make_ball(radius_m - wall_m, 0, 4));
  // The facets of the outer surface are up to 0.05 mm below the sphere.
  return {"ball", geometry::Surface::build(mesh), 0.03,
          [](const glm::dvec3& point_m) { return glm::length(point_m) - (radius_m - 0.00005); },
          [](const glm::dvec3& point_m) { return radius_m - wall_m - glm::length(point_m); }};
}

using Random = std::mt19937_64;

double between(Random& random, double low, double high) {
  return low + (high - low) * (static_cast<double>(random() >> 11) * 0x1p-53);
}

glm::dvec3 direction(Random& random) {
  const double z = between(random, -1, 1);
  const double angle_rad = between(random, 0, 2 * std::numbers::pi);
  return {std::sqrt(1 - z * z) * std::cos(angle_rad), std::sqrt(1 - z * z) * std::sin(angle_rad), z};
}

glm::dvec3 in_cube_m(Random& random, double size_m) {
  return {between(random, -size_m, size_m), between(random, -size_m, size_m), between(random, -size_m, size_m)};
}

}  // namespace

std::vector<HollowBody> hollow_bodies() {
  constexpr double wall_m = 0.0002;
  const Outline square_m{{-0.02, -0.02}, {0.02, -0.02}, {0.02, 0.02}, {-0.02, 0.02}};
  Outline star_m;
  for (unsigned corner = 0; corner < 14; ++corner) {
    const double angle_rad = 2 * std::numbers::pi * corner / 14;
    star_m.push_back(glm::dvec2{std::cos(angle_rad), std::sin(angle_rad)} * (corner % 2 == 0 ? 0.03 : 0.014));
  }
  // A comb: slits of 2.4 mm between teeth of 3 mm. The inner surface is 0.2 mm below the outer surface.
  Outline comb_m{{-0.0135, -0.02}, {0.0135, -0.02}};
  Outline comb_inside_m{{-0.0135 + wall_m, -0.02 + wall_m}, {0.0135 - wall_m, -0.02 + wall_m}};
  for (int tooth = 2; tooth >= -2; --tooth) {
    const double middle_m = tooth * 0.0054;
    for (const double side : {1.0, -1.0}) {
      const double edge_m = std::abs(tooth) == 2 && side * tooth > 0 ? 0.0027 : 0.0015;
      const double x_m = middle_m + side * edge_m;
      const double inside_x_m = x_m - side * wall_m;
      const bool is_outermost = edge_m > 0.002;
      if (side > 0 && !is_outermost) {
        comb_m.push_back({x_m, -0.005});
        comb_inside_m.push_back({inside_x_m, -0.005 - wall_m});
      }
      comb_m.push_back({x_m, 0.02});
      comb_inside_m.push_back({inside_x_m, 0.02 - wall_m});
      if (side < 0 && !is_outermost) {
        comb_m.push_back({x_m, -0.005});
        comb_inside_m.push_back({inside_x_m, -0.005 - wall_m});
      }
    }
  }
  return {hollow_prism("box", square_m, scaled(square_m, 0.99), 0.04, wall_m),
          hollow_prism("star", star_m, scaled(star_m, 0.99), 0.02, wall_m),
          hollow_prism("comb", comb_m, comb_inside_m, 0.02, wall_m), hollow_ball()};
}

PathResult run_path(const std::vector<HollowBody>& bodies, std::uint64_t number) {
  Random random(number * 0x9E3779B97F4A7C15 + 1);
  const HollowBody& body = bodies[random() % bodies.size()];
  const bool is_inside = random() % 2 == 0;
  const bool moves = random() % 3 == 0;
  const auto& distance_m = is_inside ? body.distance_from_inside_m : body.distance_from_outside_m;
  contact::Tool tool;
  const bool has_small_tip = is_inside || random() % 2 == 0;
  tool.radius_m = has_small_tip ? between(random, 0.0005, 0.0013) : between(random, 0.0005, 0.004);

  contact::Scene scene;
  contact::Object object;
  object.id = 1;
  object.shape = body.surface;
  object.placement.rotation = glm::angleAxis(between(random, 0, 3), direction(random));
  object.placement.position_m = in_cube_m(random, 0.05);
  scene.objects.push_back(object);
  contact::Placement& placement = scene.objects[0].placement;

  glm::dvec3 start_m = in_cube_m(random, body.size_m);
  for (int trial = 0; trial < 10000 && distance_m(start_m) < tool.radius_m + start_clearance_m; ++trial)
    start_m = in_cube_m(random, body.size_m);
  PathResult result;
  if (distance_m(start_m) < tool.radius_m + start_clearance_m) return result;
  contact::Pose hand;
  hand.position_m = placement.to_workspace(start_m);
  glm::dvec3 velocity_m_per_s{};
  glm::dvec3 body_velocity_m_per_s{};
  glm::dvec3 body_spin_rad_per_s{};
  for (unsigned step = 0; step < steps_per_path; ++step) {
    constexpr double period_s = 0.001;
    if (step % 25 == 0) {
      // Half of the paths lead to a random point of the body, the others into a random direction.
      const glm::dvec3 target_m = placement.to_workspace(in_cube_m(random, body.size_m));
      const glm::dvec3 toward =
          target_m == hand.position_m ? glm::dvec3{1, 0, 0} : glm::normalize(target_m - hand.position_m);
      velocity_m_per_s = (random() % 2 == 0 ? toward : direction(random)) * between(random, 0, 2);
      if (moves) {
        body_velocity_m_per_s = direction(random) * between(random, 0, 1);
        body_spin_rad_per_s = direction(random) * between(random, 0, 20);
      }
    }
    if (step > 0) {
      hand.position_m += velocity_m_per_s * period_s;
      placement.position_m += body_velocity_m_per_s * period_s;
      if (glm::length(body_spin_rad_per_s) > 0)
        placement.rotation = glm::normalize(
            glm::angleAxis(glm::length(body_spin_rad_per_s) * period_s, glm::normalize(body_spin_rad_per_s)) *
            placement.rotation);
    }
    hand.velocity_m_per_s = velocity_m_per_s;
    const contact::Step done = contact::step(scene, tool, hand);
    const double clearance_m = distance_m(placement.to_object(done.proxy_m)) - tool.radius_m;
    result.least_clearance_m = std::min(result.least_clearance_m, clearance_m);
    if (done.contact_count > 0) ++result.touching_steps;
    if (clearance_m < -tolerance_m) {
      result.passed = true;
      break;
    }
  }
  return result;
}

}  // namespace inkwell::contact_trial
