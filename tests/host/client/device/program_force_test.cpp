#include <doctest/doctest.h>

#include <functional>
#include <limits>
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
  return shapes;
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
  REQUIRE(link::decode_shapes(
      std::as_bytes(std::span(&report, 1)).first(protocol::shapes_report_size(report.plane_count)), shapes));
  for (std::size_t index = 0; index < protocol::shape_planes_maximum; ++index)
    CHECK((shapes.life_periods[1 + index] != 0) == (index == 0 || index == 5));
  CHECK(shapes.planes[5].normal == control::Vector3{0, -1, 0});
  CHECK(shapes.planes[5].offset_m == doctest::Approx(-0.02f));
  CHECK(shapes.life_periods[0] != 0);
  CHECK(shapes.sphere.centre_m == control::Vector3{0, 0, -0.05f});
  CHECK(shapes.sphere.radius_m == 0.02f);
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
