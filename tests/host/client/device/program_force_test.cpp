#include <doctest/doctest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "firmware/link/program_requests.hpp"
#include "host/client/device/error.hpp"
#include "host/client/device/program_force.hpp"

using namespace inkwell;

namespace {

constexpr float not_a_number = std::numeric_limits<float>::quiet_NaN();

device::Shapes valid_shapes() {
  device::Shapes shapes;
  shapes.planes[0] = device::Plane{};
  shapes.planes[5] = device::Plane{.point_m = {0.01f, 0.02f, 0.03f},
                                   .normal = {0, -2, 0},
                                   .surface = {.stiffness_N_per_m = 3000,
                                               .damping_Ns_per_m = 20,
                                               .static_friction = 3,
                                               .dynamic_friction = 3,
                                               .life_s = 10}};
  shapes.sphere = device::Sphere{.centre_m = {0, 0, -0.05f}};
  shapes.solids = {device::Solid{}, device::Solid{.kind = protocol::SolidKind::box, .size_m = {0.01f, 0.02f, 0.03f}}};
  return shapes;
}

constexpr protocol::MaterialEntry wood{1200, 3, 0.5f, 0.4f, 0.1f};

/// Decodes a report as the board does.
std::optional<control::ForceTarget> decode(const protocol::LocalModelReport& report, control::LocalModel& model) {
  link::Materials materials{};
  materials[3] = {1200, 1.0f / 1200, 3, 0.5f, 0.4f, 0.1f};
  return link::decode_local_model(std::as_bytes(std::span(&report, 1)), materials, &model);
}

float distance(const control::Vector3& a, const std::array<float, 3>& b) {
  return std::hypot(a.x - b[0], a.y - b[1], a.z - b[2]);
}

}  // namespace

TEST_CASE("a force is sent unchanged, and the firmware accepts it") {
  auto report = device::force_report(
      {.force_N = {1.0f, -2.0f, 3.0f}, .mode = protocol::ForceMode::instead_of_walls, .interval_ms = 50});
  const auto target = link::decode_force(std::as_bytes(std::span(&report, 1)));
  REQUIRE(target.has_value());
  CHECK(target->force_N == control::Vector3{1.0f, -2.0f, 3.0f});
  CHECK(target->mode == protocol::ForceMode::instead_of_walls);
  CHECK(target->interval_periods == 1000);
}

TEST_CASE("shapes keep their indices, those that are not there have no life, and the firmware takes them") {
  const auto report = device::shapes_report(valid_shapes());
  CHECK(report.plane_count == 6);
  control::Shapes shapes;
  link::Materials materials{};
  REQUIRE(link::decode_shapes(
      std::as_bytes(std::span(&report, 1)).first(protocol::shapes_report_size(report.plane_count, report.solid_count)),
      shapes, materials));
  for (std::size_t index = 0; index < protocol::shape_planes_maximum; ++index)
    CHECK((shapes.life_periods[index] != 0) == (index == 0 || index == 5));
  CHECK(shapes.planes[5].normal == control::Vector3{0, -1, 0});
  CHECK(shapes.planes[5].offset_m == doctest::Approx(-0.02f));
  CHECK(shapes.life_periods[control::Shapes::maximum - 1] != 0);
  const control::Solid& sphere = shapes.solids[protocol::shape_solids_maximum];
  CHECK(sphere.centre_m == control::Vector3{0, 0, -0.05f});
  CHECK(sphere.radius_m == 0.02f);
  CHECK(shapes.surfaces[0].stiffness_N_per_m == 800.0f);
  CHECK(device::shapes_report({}).plane_count == 0);
}

TEST_CASE("values that the firmware would refuse are refused with the value and its limit") {
  struct Case {
    std::function<void(device::Shapes&)> change;
    std::string words;
  };
  const std::vector<Case> cases{
      {[](auto& shapes) { shapes.planes[5]->surface.stiffness_N_per_m = 0; }, "stiffness of plane 5 is 0 N/m"},
      {[](auto& shapes) { shapes.planes[5]->surface.stiffness_N_per_m = 3001; }, "at most 3000 N/m"},
      {[](auto& shapes) { shapes.planes[5]->surface.stiffness_N_per_m = not_a_number; }, "stiffness of plane 5"},
      {[](auto& shapes) { shapes.planes[5]->surface.damping_Ns_per_m = -1; }, "from 0 to 20 Ns/m"},
      {[](auto& shapes) { shapes.planes[5]->surface.static_friction = 3.1f; }, "static friction of plane 5"},
      {[](auto& shapes) { shapes.planes[0]->surface.dynamic_friction = 0.1f; }, "dynamic friction of plane 0"},
      {[](auto& shapes) { shapes.planes[0]->surface.life_s = 11; }, "life of plane 0 is 11 s"},
      {[](auto& shapes) { shapes.planes[0]->surface.life_s = 0; }, "life of plane 0"},
      {[](auto& shapes) { shapes.planes[0]->point_m[2] = 10.5f; }, "coordinate of plane 0 is 10.5 m"},
      {[](auto& shapes) { shapes.planes[0]->normal[2] = not_a_number; }, "normal of plane 0"},
      {[](auto& shapes) { shapes.planes[0]->normal = {}; }, "has length 0"},
      {[](auto& shapes) { shapes.sphere->radius_m = 0; }, "radius is not above 0"},
      {[](auto& shapes) { shapes.sphere->radius_m = 11; }, "sphere's radius is 11 m"},
      {[](auto& shapes) { shapes.sphere->centre_m[0] = not_a_number; }, "coordinate of the sphere"},
      {[](auto& shapes) { shapes.sphere->surface.damping_Ns_per_m = 21; }, "damping of the sphere is 21 Ns/m"},
      {[](auto& shapes) { shapes.sphere->surface.viscosity_Ns_per_m = 21; }, "viscosity of the sphere is 21 Ns/m"},
      {[](auto& shapes) { shapes.solids[1].size_m[2] = 0; }, "size of solid 1 (box) is 0 m"},
      {[](auto& shapes) { shapes.solids[1].orientation = {}; }, "orientation of solid 1 (box)"},
      {[](auto& shapes) { shapes.solids.resize(17); }, "17 solids are too many"},
      {[](auto& shapes) { shapes.materials.resize(17); }, "17 materials are too many"},
      {[](auto& shapes) { shapes.materials.resize(1); }, "stiffness of material 0 is 0 N/m"},
  };
  for (const Case& one : cases) {
    CAPTURE(one.words);
    device::Shapes shapes = valid_shapes();
    one.change(shapes);
    try {
      device::shapes_report(shapes);
      FAIL("it was taken");
    } catch (const device::Error& error) {
      CHECK_MESSAGE(std::string(error.what()).find(one.words) != std::string::npos, error.what());
    }
  }
  for (const int interval_ms : {0, 51})
    CHECK_THROWS_AS(device::force_report({.interval_ms = interval_ms}), device::Error);
  for (const float force_N : {not_a_number, std::numeric_limits<float>::infinity()})
    CHECK_THROWS_AS(device::force_report({.force_N = {0, 0, force_N}}), device::Error);
}

TEST_CASE("solids and materials arrive at the board with their values") {
  device::Shapes shapes = valid_shapes();
  const float half = std::sqrt(0.5f);
  shapes.solids.push_back({.kind = protocol::SolidKind::capsule,
                           .centre_m = {0.01f, 0, 0},
                           .orientation = {half, half, 0, 0},  // a quarter turn around x: z becomes -y
                           .size_m = {0.005f, 0.02f, 0}});
  shapes.solids.push_back({.kind = protocol::SolidKind::cylinder, .size_m = {0.01f, 0.02f, 0}});
  shapes.materials = {wood, wood};
  const auto report = device::shapes_report(shapes);
  control::Shapes decoded;
  link::Materials materials{};
  REQUIRE(link::decode_shapes(std::as_bytes(std::span(&report, 1)), decoded, materials));
  using Core = control::Solid::Core;
  CHECK(decoded.solids[0].core == Core::point);
  CHECK(decoded.solids[1].core == Core::box);
  CHECK(decoded.solids[1].half_m[2] == doctest::Approx(0.0295f));
  CHECK(decoded.solids[2].core == Core::segment);
  CHECK(decoded.solids[2].radius_m == 0.005f);
  CHECK(decoded.solids[2].half_m[0] == 0.02f);
  CHECK(decoded.solids[2].axes[0].y == doctest::Approx(-1.0f));
  CHECK(decoded.solids[3].core == Core::cylinder);
  CHECK(decoded.solids[3].core_radius_m == doctest::Approx(0.0095f));
  CHECK(decoded.solids[protocol::shape_solids_maximum].core == Core::point);  // the sphere
  CHECK(materials[1].stiffness_N_per_m == 1200);
  CHECK(materials[1].viscosity_Ns_per_m == 0.1f);
  CHECK(materials[2].stiffness_N_per_m == 0);
}

TEST_CASE("a local model arrives at the board within the resolution of the report") {
  device::LocalModel model;
  const std::array<float, 3> direction{0.48f, -0.6f, 0.64f};
  model.anchor_m = {0.0312f, -0.0471f, 0.0523f};
  model.features = {device::Feature{.direction = direction, .point_m = {0.032f, -0.046f, 0.05f}, .material = 3},
                    device::Feature{.kind = protocol::FeatureKind::cylinder,
                                    .direction = direction,
                                    .point_m = {0.035f, -0.046f, 0.051f},
                                    .radius_m = 0.001f,
                                    .material = 3,
                                    .moves = true},
                    device::Feature{.kind = protocol::FeatureKind::sphere,
                                    .point_m = {0.03f, -0.04f, 0.045f},
                                    .radius_m = 0.008f,
                                    .material = 3,
                                    .moves = true}};
  model.count = 3;
  model.velocity_m_per_s = {0.1f, -0.2f, 0.3f};
  model.spin_rad_per_s = {0, 0, 2.0f};
  model.life_ms = 5;
  control::LocalModel decoded;
  const auto target =
      decode(device::local_model_report(model, {.force_N = {0.5f, -1.25f, 3}, .interval_ms = 2}), decoded);
  REQUIRE(target);
  CHECK(target->force_N.y == doctest::Approx(-1.25f));
  CHECK(target->interval_periods == 40);
  CHECK(decoded.count == 3);
  CHECK(decoded.life_periods == 100);
  const auto& [plane, cylinder, sphere] = decoded.features;
  CHECK(dot(plane.axis, {0.48f, -0.6f, 0.64f}) == doctest::Approx(1.0f));
  CHECK(std::fabs(dot(plane.axis, plane.centre_m - control::Vector3{0.032f, -0.046f, 0.05f})) < 2e-6f);
  CHECK(plane.motion.velocity_m_per_s == control::Vector3{});
  CHECK(plane.surface.stiffness_N_per_m == 1200);
  const control::Vector3 to_axis_m = cylinder.centre_m - control::Vector3{0.035f, -0.046f, 0.051f};
  const control::Vector3 off_m = to_axis_m - dot(to_axis_m, cylinder.axis) * cylinder.axis;
  CHECK(std::sqrt(dot(off_m, off_m)) < 3e-6f);
  CHECK(cylinder.radius_m == doctest::Approx(0.001f));
  CHECK(distance(sphere.centre_m, {0.03f, -0.04f, 0.045f}) < 3e-6f);
  CHECK(sphere.radius_m == doctest::Approx(0.008f));
  CHECK(sphere.motion.velocity_m_per_s.x == doctest::Approx(0.1f - 2.0f * (-0.04f + 0.0471f)).epsilon(1e-3));
  CHECK(cylinder.axis_rate_per_s.x == doctest::Approx(1.2f).epsilon(1e-3));
}

TEST_CASE("a second cylinder radius, and a radius beyond the report, become tangent planes") {
  device::LocalModel model;
  model.count = 3;
  model.features.fill(
      {.kind = protocol::FeatureKind::cylinder, .direction = {1, 0, 0}, .point_m = {0, 0, -0.01f}, .radius_m = 0.01f});
  model.features[1].radius_m = 0.005f;
  model.features[2] = {.kind = protocol::FeatureKind::sphere, .point_m = {0, 0, -0.2f}, .radius_m = 0.19f};
  for (auto& feature : model.features) feature.material = 3;
  control::LocalModel decoded;
  REQUIRE(decode(device::local_model_report(model, {}), decoded));
  CHECK(decoded.features[0].kind == protocol::FeatureKind::cylinder);
  for (const std::size_t i : {1u, 2u}) {
    CHECK(decoded.features[i].kind == protocol::FeatureKind::plane);
    CHECK(decoded.features[i].axis.z == doctest::Approx(1.0f));
    CHECK(decoded.features[i].centre_m.z == doctest::Approx(i == 1 ? -0.005f : -0.01f));
  }
}

TEST_CASE("a local model with invalid values is refused, here and by the board") {
  device::LocalModel model;
  model.count = 1;
  model.features[0].material = 3;
  control::LocalModel decoded;
  REQUIRE(decode(device::local_model_report(model, {}), decoded));
  for (const auto& change : std::vector<std::function<void(device::LocalModel&)>>{
           [](auto& each) { each.count = 4; },
           [](auto& each) { each.life_ms = 0; },
           [](auto& each) { each.life_ms = 21; },
           [](auto& each) { each.features[0].material = 16; },
           [](auto& each) { each.features[0].point_m[1] = not_a_number; },
           [](auto& each) { each.features[0].point_m[2] = 0.1f; },
           [](auto& each) { each.velocity_m_per_s[0] = not_a_number; },
       }) {
    device::LocalModel wrong = model;
    change(wrong);
    CHECK_THROWS_AS(device::local_model_report(wrong, {}), device::Error);
  }
  const auto valid = device::local_model_report(model, {});
  for (const auto& change : std::vector<std::function<void(protocol::LocalModelReport&)>>{
           [](auto& each) { each.mode = static_cast<protocol::ForceMode>(3); },
           [](auto& each) { each.interval_ms = 0; }, [](auto& each) { each.interval_ms = 51; },
           [](auto& each) { each.life_ms = 0; }, [](auto& each) { each.life_ms = 21; },
           [](auto& each) { each.feature_count = 4; }, [](auto& each) { each.features[0].material = 2; },
           [](auto& each) { each.features[0].kind = static_cast<protocol::FeatureKind>(3); },
           [](auto& each) { each.features[0].kind = protocol::FeatureKind::sphere; },  // radius 0
       }) {
    auto wrong = valid;
    change(wrong);
    CHECK(!decode(wrong, decoded));
  }
}
