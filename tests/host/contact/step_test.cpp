#include "host/contact/step.hpp"

#include <doctest/doctest.h>

#include <cstdlib>
#include <new>
#include <numbers>
#include <random>

#include <glm/gtc/quaternion.hpp>

#include "tests/host/contact/fall_through.hpp"
#include "tests/host/contact/hand.hpp"

namespace {
std::uint64_t allocations = 0;
}  // namespace

void* operator new(std::size_t size) {
  ++allocations;
  if (void* const memory = std::malloc(size == 0 ? 1 : size)) return memory;
  throw std::bad_alloc();
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }

namespace inkwell::contact {
namespace {

using Kind = Feature::Kind;
constexpr double stiffness_N_per_m = 500;

double degrees_between(const glm::dvec3& left, const glm::dvec3& right) {
  return std::atan2(glm::length(glm::cross(left, right)), glm::dot(left, right)) * 180 / std::numbers::pi;
}

/// A flat net of squares with random diagonals in the plane z = 0.
geometry::Mesh flat_net(int cells, double cell_m) {
  geometry::Mesh mesh;
  std::mt19937 random(3);
  for (int row = 0; row <= cells; ++row)
    for (int column = 0; column <= cells; ++column)
      mesh.vertices_m.push_back(glm::vec3{glm::dvec3{column - cells / 2.0, row - cells / 2.0, 0} * cell_m});
  for (int row = 0; row < cells; ++row)
    for (int column = 0; column < cells; ++column) {
      const auto corner = static_cast<std::uint32_t>(row * (cells + 1) + column);
      const auto above = corner + static_cast<std::uint32_t>(cells) + 1;
      if (random() % 2 == 0) {
        mesh.faces.push_back({corner, corner + 1, above + 1});
        mesh.faces.push_back({corner, above + 1, above});
      } else {
        mesh.faces.push_back({corner, corner + 1, above});
        mesh.faces.push_back({corner + 1, above + 1, above});
      }
    }
  return mesh;
}

Hand hand_at(const geometry::Mesh& mesh, double radius_m, const glm::dvec3& start_m, bool is_smooth = false) {
  return {scene_with(surface_of(mesh), is_smooth), radius_m, start_m};
}

}  // namespace

TEST_CASE("in free motion the proxy is at the hand, and nothing is touched") {
  Hand hand = hand_at(geometry::make_ball(0.02, 0, 3), 0.001, {0, 0, 0.05});
  hand.go_straight({0.03, 0.01, 0.05}, 0.002);
  CHECK(hand.last.proxy_m == hand.pose.position_m);
  CHECK(hand.last.contact_count == 0);
}

TEST_CASE("a tip radius below 0.5 mm, also 0, is felt as 0.5 mm") {
  for (const double radius_m : {0.0, 0.0002, 0.0005}) {
    Hand hand = hand_at(geometry::make_box({0.04, 0.04, 0.01}), radius_m, {0, 0, 0.01});
    hand.go_straight({0.001, 0.002, 0.004});
    CHECK(hand.last.proxy_m.z == doctest::Approx(0.0055).epsilon(0.001));
  }
}

TEST_CASE("the tip passes no plate of 0.2 mm at 2 m/s, from either side and at any phase of the step") {
  for (const double side : {1.0, -1.0})
    for (int phase = 0; phase < 40; ++phase) {
      Hand hand = hand_at(geometry::make_box({0.04, 0.04, 0.0002}), 0.0005, {0, 0, side * (0.01 + phase * 0.00005)});
      hand.go_straight({0.003, 0.001, side * -0.05}, 0.002);
      CHECK(hand.last.proxy_m.z * side == doctest::Approx(0.000601).epsilon(1e-4));
      REQUIRE(hand.last.contact_count == 1);
      CHECK(hand.last.contacts[0].normal.z == doctest::Approx(side));
    }
}

TEST_CASE("an open mesh is a sheet that is felt from both sides, and the tip slides around its border") {
  for (const double side : {1.0, -1.0}) {
    Hand hand = hand_at(flat_net(8, 0.005), 0.001, {0.0013, 0.002, side * 0.005});
    hand.go_straight({0.0013, 0.002, side * -0.003});
    CHECK(hand.last.proxy_m.z * side == doctest::Approx(0.001001).epsilon(1e-4));
    hand.go_straight({0.03, 0.002, side * -0.003});
    CHECK(hand.last.proxy_m == hand.pose.position_m);
  }
}

TEST_CASE("edges between coplanar triangles cause no sideways force and do not stop the tip") {
  Hand hand = hand_at(flat_net(20, 0.002), 0.001, {-0.015, -0.011, 0.002});
  hand.go_straight({-0.015, -0.011, -0.002});
  for (int number = 0; number < 300; ++number) {
    const double part = number / 300.0;
    hand.go({-0.015 + 0.03 * part, -0.011 + 0.021 * part, -0.002 - 0.002 * std::sin(9 * part)});
    CHECK(std::hypot(hand.stretch_m().x, hand.stretch_m().y) < 1e-6);
    CHECK(hand.last.proxy_m.z == doctest::Approx(0.001001).epsilon(1e-3));
    REQUIRE(hand.last.model.count == 1);
    CHECK(hand.last.model.features[0].kind == Kind::plane);
    CHECK(hand.last.model.features[0].direction.z == doctest::Approx(1));
    CHECK(hand.last.model.features[0].id == 1);
  }
}

TEST_CASE("the tip slides around a ball and into a groove of very small triangles") {
  const geometry::Mesh ball = geometry::make_ball(0.005, 0, 6);
  Scene scene = scene_with(surface_of(ball));
  scene.objects.push_back(scene.objects[0]);
  scene.objects[1].id = 6;
  scene.objects[1].placement.position_m = {0.009, 0, 0};
  Hand hand{std::move(scene), 0.001, {0, 0, 0.01}};
  for (int number = 0; number < 300; ++number) {
    const double angle_rad = 0.004 * number;
    hand.go(0.0055 * glm::dvec3{std::sin(angle_rad), 0, std::cos(angle_rad)});
    CHECK(glm::length(hand.last.proxy_m) > 0.00599);
    CHECK(glm::distance(hand.last.proxy_m, glm::dvec3{0.009, 0, 0}) > 0.00599);
  }
  CHECK(hand.last.proxy_m.x == doctest::Approx(0.0045).epsilon(0.01));
  CHECK(hand.last.model.count == 2);
}

TEST_CASE("a corner of three faces holds the tip") {
  // The inside of a box: all faces turned.
  geometry::Mesh mesh = geometry::make_box({0.04, 0.04, 0.04});
  for (geometry::Face& face : mesh.faces) std::swap(face[0], face[1]);
  Hand hand = hand_at(mesh, 0.001, {0, 0, 0});
  hand.go_straight({0.03, 0.028, 0.025}, 0.002);
  for (int axis = 0; axis < 3; ++axis) CHECK(hand.last.proxy_m[axis] == doctest::Approx(0.018999).epsilon(1e-5));
  CHECK(hand.last.contact_count == 3);
  REQUIRE(hand.last.model.count == 3);
  CHECK(glm::distance(project(hand.last.model, hand.pose.position_m), hand.last.proxy_m) < 3e-6);
}

TEST_CASE("a face is a plane, a convex edge a cylinder and a corner a sphere of the tip's radius") {
  const auto feature_at = [](const glm::dvec3& position_m) {
    Hand hand = hand_at(geometry::make_box({0.02, 0.02, 0.02}), 0.0015, position_m);
    REQUIRE(hand.last.model.count == 1);
    return hand.last.model.features[0];
  };
  const Feature face = feature_at({0.001, 0.002, 0.0125});
  CHECK(face.kind == Kind::plane);
  CHECK(glm::distance(face.direction, {0, 0, 1}) < 1e-6f);
  CHECK(face.point_m.z == doctest::Approx(0.0115));
  CHECK(face.material == 3);
  CHECK(!face.moves);
  const Feature edge = feature_at({0.0112, 0.002, 0.0112});
  CHECK(edge.kind == Kind::cylinder);
  CHECK(std::abs(edge.direction.y) == doctest::Approx(1));
  CHECK(glm::distance(edge.point_m, {0.01f, 0.002f, 0.01f}) < 1e-6f);
  CHECK(edge.radius_m == doctest::Approx(0.0015));
  const Feature corner = feature_at({0.0111, 0.0112, 0.0113});
  CHECK(corner.kind == Kind::sphere);
  CHECK(glm::distance(corner.point_m, {0.01f, 0.01f, 0.01f}) < 1e-6f);
  CHECK(corner.radius_m == doctest::Approx(0.0015));
}

TEST_CASE("features are sent from 2 mm plus 3 ms of motion ahead of contact") {
  Hand hand = hand_at(geometry::make_box({0.04, 0.04, 0.02}), 0.001, {0, 0, 0.0131});
  CHECK(hand.last.model.count == 0);
  hand.go({0, 0, 0.01299});
  CHECK(hand.last.model.count == 1);
  CHECK(hand.last.contact_count == 0);
  hand.go_straight({-0.002, 0, 0.0191});
  hand.go({0, 0, 0.0191});
  CHECK(hand.last.model.count == 0);
  hand.go({0, 0, 0.0171});
  hand.go({0.002, 0, 0.0171});
  CHECK(hand.last.model.count == 1);
}

TEST_CASE("a surface that the tip will touch in 10 ms precedes the nearest surfaces") {
  // The nearest parts of a box below the tip at its side are two edges and a corner.
  const Scene scene = scene_with(surface_of(geometry::make_box({0.04, 0.04, 0.02})));
  Hand hand(scene, 0.001, {0, 0, 0.0351});
  hand.go({0, 0, 0.0331});
  CHECK(hand.last.model.count == 0);
  hand.go({0, 0, 0.0301});
  REQUIRE(hand.last.model.count == 1);
  CHECK(hand.last.model.features[0].direction == glm::vec3(0, 0, 1));
  CHECK(hand.last.contact_count == 0);
  // The tip moves past an edge that is nearer than the face that it will touch.
  Hand beside(scene, 0.001, {0.0225, 0, 0.0145});
  beside.go({0.0205, 0, 0.0135});
  REQUIRE(beside.last.model.count >= 1);
  CHECK(beside.last.model.features[0].kind == Kind::plane);
  CHECK(beside.last.model.features[0].direction == glm::vec3(0, 0, 1));
}

TEST_CASE("an edge is a plane for a hand that is deeper than the radius of the tip") {
  Hand hand = hand_at(geometry::make_box({0.02, 0.02, 0.02}), 0.0015, {0.012, 0, 0.012});
  const auto feature_below = [&](double depth_m) {
    const double along_m = 0.01 + (0.0015 - depth_m) / std::numbers::sqrt2;
    hand.go_straight({along_m, 0, along_m});
    hand.stay(10);
    REQUIRE(hand.last.model.count >= 1);
    return hand.last.model.features[0];
  };
  CHECK(feature_below(0.0005).kind == Kind::cylinder);
  const Feature plane = feature_below(0.002);
  CHECK(plane.kind == Kind::plane);
  CHECK(degrees_between(glm::dvec3{plane.direction}, {1, 0, 1}) < 0.1);
  CHECK(glm::distance(hand.last.proxy_m, glm::dvec3{plane.point_m}) < 3e-6);
}

TEST_CASE("friction holds the proxy back") {
  Scene scene = scene_with(surface_of(flat_net(20, 0.002)));
  scene.materials[3] = {.stiffness_N_per_m = 500, .static_friction = 0.5f, .dynamic_friction = 0.4f};
  Hand hand(scene, 0.001, {0, 0, 0.002});
  hand.go_straight({0, 0, 0});
  constexpr double depth_m = 0.001;
  SUBCASE("it sticks up to the static friction, and then it slides with the dynamic friction") {
    hand.go_straight({0.45 * depth_m, 0, 0}, 0.00001);
    CHECK(hand.last.proxy_m.x == doctest::Approx(0).scale(1).epsilon(1e-6));
    hand.go_straight({0.003, 0, 0}, 0.00001);
    CHECK(hand.last.proxy_m.x == doctest::Approx(0.003 - 0.4 * depth_m).epsilon(0.01).scale(0));
  }
  SUBCASE("the force of the board shows the proxy of the board") {
    const glm::dvec3 board_m{0.0002, -0.0001, depth_m};
    hand.pose.force_N = 500.0 * board_m;
    hand.stay(1);
    CHECK(glm::distance(hand.last.proxy_m, board_m) < 3e-6);
    hand.pose.force_N = 500.0 * glm::dvec3{0.01, 0, depth_m};
    hand.stay(1);
    CHECK(hand.last.proxy_m.x == doctest::Approx(0.4 * depth_m).epsilon(0.01).scale(0));
  }
  SUBCASE("above the force limit, friction holds as at the limit") {
    hand.pose.force_limit_N = 0.25;
    hand.go_straight({0.003, 0, 0}, 0.00001);
    CHECK(hand.last.proxy_m.x == doctest::Approx(0.003 - 0.4 * 0.25 / 500).epsilon(0.01).scale(0));
  }
  SUBCASE("a moving object carries the proxy") {
    for (int step = 0; step < 10; ++step) {
      hand.scene.objects[0].placement.position_m.x += 0.00002;
      hand.stay(1);
    }
    CHECK(hand.last.proxy_m.x == doctest::Approx(0.0002).epsilon(0.01).scale(0));
  }
  SUBCASE("a material without stiffness has no force") {
    hand.scene.materials[3].stiffness_N_per_m = 0;
    hand.pose.force_N = {1, 0, 1};
    hand.stay(1);
    CHECK(std::isfinite(hand.last.proxy_m.x));
  }
}

TEST_CASE("the tip at the inner edge of a stair has the planes of tread and riser") {
  const auto stairs = std::ranges::find(geometry::examples(), "stairs", &geometry::Example::name);
  Hand hand = hand_at(stairs->make(), 0.001, {-0.018, 0, 0});
  hand.go_straight({-0.018, -0.0145, 0});
  REQUIRE(hand.last.contact_count == 1);
  CHECK(hand.last.contacts[0].normal.y == doctest::Approx(1));
  CHECK(hand.last.model.count == 1);
  hand.go_straight({-0.0115, -0.0145, 0});
  CHECK(glm::distance(hand.last.proxy_m, {-0.013001, -0.012999, 0}) < 1e-6);
  CHECK(hand.last.contact_count == 2);
  CHECK(hand.last.model.count == 2);
}

TEST_CASE("the proxy is in the free space of every feature, and projecting the hand gives the proxy") {
  for (const geometry::Example& example : geometry::examples()) {
    CAPTURE(example.name);
    Hand hand = hand_at(example.make(), 0.001, {0.06, 0.06, 0.06});
    std::mt19937 random(2);
    const auto coordinate = [&] { return static_cast<double>(random()) / 4294967295.0 * 0.08 - 0.04; };
    for (int goal = 0; goal < 12; ++goal) {
      hand.go_straight({coordinate(), coordinate(), coordinate()}, 0.0005);
      hand.stay(3);
      const LocalModel& model = hand.last.model;
      for (std::size_t index = 0; index < model.count; ++index) {
        const Feature& feature = model.features[index];
        glm::dvec3 from_m = hand.last.proxy_m - glm::dvec3{feature.point_m};
        const glm::dvec3 direction{feature.direction};
        if (feature.kind == Kind::cylinder) from_m -= direction * glm::dot(from_m, direction);
        const double height_m = feature.kind == Kind::plane
                                    ? glm::dot(from_m, direction)
                                    : glm::length(from_m) - static_cast<double>(feature.radius_m);
        CHECK(height_m > -1e-6);
      }
      CHECK(glm::distance(hand.last.proxy_m, glm::dvec3{model.anchor_m}) < 0.015);
    }
  }
}

TEST_CASE("a contact keeps its number over faces and edges, and a new contact gets a new number") {
  Hand hand = hand_at(geometry::make_box({0.02, 0.02, 0.02}), 0.001, {0, 0, 0.0125});
  const std::uint32_t id = hand.last.model.features[0].id;
  hand.go_straight({0, 0, 0.0095});
  hand.go_straight({0.0095, 0, 0.0095});
  hand.go_straight({0.0101, 0, 0.0101}, 0.00005);
  REQUIRE(hand.last.model.count == 1);
  CHECK(hand.last.model.features[0].kind == Kind::cylinder);
  CHECK(hand.last.model.features[0].id == id);
  hand.go_straight({0, 0, 0.03});
  hand.go_straight({0, 0, 0.0095});
  CHECK(hand.last.model.features[0].id != id);
}

TEST_CASE("contacts name the object, the face of the source mesh, the point and the depth") {
  const geometry::Mesh mesh = geometry::make_ball(0.02, 0, 2);
  Hand hand = hand_at(mesh, 0.001, {0.01, 0.02, 0.04});
  hand.go_straight({0.004, 0.008, 0.016});
  REQUIRE(hand.last.contact_count == 1);
  const Contact& contact = hand.last.contacts[0];
  CHECK(contact.object == 5);
  const geometry::Face& face = mesh.faces[contact.triangle];
  const geometry::Triangle triangle{mesh.vertices_m[face[0]], mesh.vertices_m[face[1]], mesh.vertices_m[face[2]]};
  const glm::dvec3 point_m{contact.point_m};
  CHECK(glm::distance(geometry::closest_point(point_m, triangle).point_m, point_m) < 1e-6);
  CHECK(static_cast<double>(contact.depth_m) == doctest::Approx(glm::length(hand.stretch_m())).epsilon(0.01).scale(0));
}

TEST_CASE("a moving plate pushes the tip at 2 m/s and does not pass it") {
  for (const double side : {1.0, -1.0}) {
    Hand hand = hand_at(geometry::make_box({0.04, 0.04, 0.0002}), 0.0005, {0.003, 0.001, side * 0.00312});
    for (int count = 0; count < 10; ++count) {
      hand.scene.objects[0].placement.position_m.z += side * 0.002;
      hand.stay(1);
      const double from_plate_m = hand.last.proxy_m.z - hand.scene.objects[0].placement.position_m.z;
      CHECK(from_plate_m * side > 0.0006);
    }
    CHECK(hand.last.contact_count == 1);
  }
}

TEST_CASE("a turning plate takes the tip along") {
  Hand hand = hand_at(geometry::make_box({0.06, 0.002, 0.04}), 0.001, {0.02, 0.004, 0});
  for (int count = 0; count < 300; ++count) {
    hand.scene.objects[0].placement.rotation = glm::angleAxis(count * 0.005, glm::dvec3{0, 0, 1});
    hand.stay(1);
    const glm::dvec3 local_m = hand.scene.objects[0].placement.to_object(hand.last.proxy_m);
    CHECK((local_m.y > 0.002 || std::abs(local_m.x) > 0.03));
  }
}

TEST_CASE("an object moves by its velocity for 20 ms after its placement, and the model has its motion") {
  Scene scene = scene_with(Sphere{0.01});
  scene.objects[0].velocity_m_per_s = {0, 0, 0.2};
  scene.objects[0].spin_rad_per_s = {0, 3, 0};
  Hand hand(scene, 0.001, {0, 0, 0.0115});
  hand.pose.scene_age_s = 0.010;
  hand.stay(1);
  CHECK(hand.last.proxy_m.z == doctest::Approx(0.013).epsilon(1e-3));
  REQUIRE(hand.last.model.count == 1);
  CHECK(hand.last.model.features[0].moves);
  CHECK(hand.last.model.spin_rad_per_s == glm::vec3{0, 3, 0});
  // The anchor is at z = 16 mm, and the origin of the object at z = 2 mm.
  CHECK(glm::distance(hand.last.model.velocity_m_per_s, {0.042f, 0, 0.2f}) < 1e-5f);
  hand.pose.scene_age_s = 0.5;
  hand.stay(1);
  CHECK(hand.last.proxy_m.z == doctest::Approx(0.015).epsilon(1e-3));
  CHECK(!hand.last.model.features[0].moves);
  CHECK(hand.last.model.velocity_m_per_s == glm::vec3{0});
}

TEST_CASE("an object that appears around the tip is felt only after the tip has left it") {
  for (const Shape& shape : {Shape{surface_of(geometry::make_ball(0.02, 0, 3))}, Shape{Sphere{0.02}}}) {
    Hand hand(scene_with(shape), 0.001, {0, 0, 0.005});
    hand.go_straight({0, 0, 0.0195});
    CHECK(hand.last.proxy_m == hand.pose.position_m);
    CHECK(hand.last.model.count == 0);
    hand.go_straight({0, 0, 0.0215});
    hand.go_straight({0, 0, 0.015});
    CHECK(hand.last.proxy_m.z > 0.0209);
  }
}

TEST_CASE("a tip between two closing objects enters the moving object, which is felt again outside") {
  Scene scene = scene_with(Box{{0.02, 0.02, 0.005}});
  scene.objects.push_back(scene.objects[0]);
  scene.objects[1].id = 6;
  scene.objects[1].placement.position_m.z = 0.015;
  Hand hand(scene, 0.001, {0, 0, 0.0075});
  for (int count = 0; count < 100; ++count) {
    hand.scene.objects[1].placement.position_m.z -= 0.0001;
    hand.stay(1);
    CHECK(hand.last.proxy_m.z > 0.0059);
  }
  hand.go_straight({0, 0, 0.03});
  CHECK(hand.last.proxy_m == hand.pose.position_m);
  hand.go_straight({0, 0, 0.0085});
  CHECK(hand.last.proxy_m.z == doctest::Approx(0.011).epsilon(1e-3));
}

TEST_CASE("a hole of 1.2 tip diameters is entered, and a hole of 0.95 never") {
  const auto plate_with_hole = [](double hole_radius_m) {
    geometry::Outline outer_m;
    geometry::Outline inner_m;
    for (unsigned corner = 0; corner < 96; ++corner) {
      const double angle_rad = 2 * std::numbers::pi * corner / 96;
      outer_m.push_back(glm::dvec2{std::cos(angle_rad), std::sin(angle_rad)} * 0.02);
      inner_m.push_back(glm::dvec2{std::cos(angle_rad), std::sin(angle_rad)} * hole_radius_m);
    }
    return geometry::extrude_ring(outer_m, inner_m, 0.004);
  };
  std::mt19937 random(4);
  for (int trial = 0; trial < 12; ++trial) {
    const double radius_m = 0.0005 + 0.0001 * trial;
    const double angle_rad = static_cast<double>(random() % 628) / 100;
    const glm::dvec3 beside_m = glm::dvec3{std::cos(angle_rad), std::sin(angle_rad), 0} * (0.15 * radius_m);
    Hand wide = hand_at(plate_with_hole(1.2 * radius_m), radius_m, glm::dvec3{0, 0, 0.01} + beside_m);
    wide.go_straight(glm::dvec3{0, 0, -0.01} + beside_m, 0.0005);
    CHECK(wide.last.proxy_m.z < -0.0099);
    Hand narrow = hand_at(plate_with_hole(0.95 * radius_m), radius_m, glm::dvec3{0, 0, 0.01} + beside_m);
    narrow.go_straight(glm::dvec3{0, 0, -0.015} - beside_m, 0.0005);
    for (int count = 0; count < 100; ++count)
      narrow.go(narrow.pose.position_m + glm::dvec3{0.0001 * std::sin(count), 0.0001 * std::cos(count * 0.7), 0});
    CHECK(narrow.last.proxy_m.z > 0.002);
  }
}

TEST_CASE("the force on fine meshes of sphere, plane and cylinder is that of the ideal bodies, with smooth normals") {
  // Edges of at most 1.2 mm: the chords sag by less than 10 um.
  Hand sphere = hand_at(geometry::make_ball(0.02, 0, 5), 0.001, {0.022, 0, 0}, true);
  Hand cylinder = hand_at(geometry::make_cylinder(0.02, 0.06, 160), 0.001, {0.022, 0, 0}, true);
  Hand plane = hand_at(flat_net(20, 0.003), 0.001, {0.01, 0, 0.0015}, true);
  const auto check = [](const Hand& hand, const glm::dvec3& outward, double depth_m) {
    const glm::dvec3 force_N =
        (project(hand.last.model, hand.pose.position_m) - hand.pose.position_m) * stiffness_N_per_m;
    CHECK(glm::length(force_N) == doctest::Approx(depth_m * stiffness_N_per_m).epsilon(0.02));
    CHECK(degrees_between(force_N, outward) < 1);
  };
  for (int number = 0; number < 4000; ++number) {
    const double angle_rad = number * 0.001;
    const double depth_m = std::min(number * 0.00001, 0.0011 + 0.0005 * std::sin(number * 0.01));
    const glm::dvec3 around{std::cos(angle_rad), std::sin(angle_rad), 0};
    const glm::dvec3 outward = glm::normalize(around + glm::dvec3{0, 0, 0.8 * std::sin(angle_rad * 0.7)});
    sphere.go(outward * (0.021 - depth_m));
    cylinder.go(around * (0.021 - depth_m) + glm::dvec3{0, 0, 0.02 * std::sin(angle_rad * 0.7)});
    plane.go(around * 0.01 + glm::dvec3{0, 0, 0.001 - depth_m});
    if (depth_m * stiffness_N_per_m < 0.5) continue;
    check(sphere, outward, depth_m);
    check(cylinder, around, depth_m);
    check(plane, {0, 0, 1}, depth_m);
  }
}

TEST_CASE("a frictionless static scene supplies at most 1 mJ over closed paths") {
  std::mt19937 random(8);
  const auto coordinate = [&] { return static_cast<double>(random()) / 2147483647.5 - 1; };
  unsigned touching = 0;
  for (const geometry::Example& example : geometry::examples()) {
    CAPTURE(example.name);
    const Scene scene = scene_with(surface_of(example.make()));
    for (int loop = 0; loop < 4; ++loop) {
      std::array<glm::dvec3, 6> waves;
      for (glm::dvec3& wave : waves) wave = glm::dvec3{coordinate(), coordinate(), coordinate()} * 0.012;
      const auto position_m = [&](double phase_rad) {
        glm::dvec3 sum_m{0, 0, 0.025 + 0.045 * std::cos(phase_rad)};
        for (std::size_t wave = 0; wave < waves.size(); ++wave)
          sum_m += waves[wave] * std::sin(static_cast<double>(wave + 1) * phase_rad);
        return sum_m;
      };
      Hand hand(scene, 0.001, position_m(0));
      double work_J = 0;
      glm::dvec3 last_force_N{};
      constexpr int steps = 4000;
      for (int number = 1; number <= steps; ++number) {
        const glm::dvec3 from_m = hand.pose.position_m;
        hand.go(position_m(2 * std::numbers::pi * number / steps));
        const glm::dvec3 force_N = hand.stretch_m() * stiffness_N_per_m;
        work_J += glm::dot((force_N + last_force_N) * 0.5, hand.pose.position_m - from_m);
        last_force_N = force_N;
        if (hand.last.contact_count > 0) ++touching;
      }
      CHECK(work_J < 0.001);
    }
  }
  CHECK(touching > 5000);
}

TEST_CASE("a step allocates no memory, also with moving objects and at its first call") {
  Scene scene = scene_with(surface_of(geometry::make_ball(0.02, 0.001, 4)));
  scene.objects.push_back({.id = 6, .shape = Capsule{0.005, 0.01}, .placement = {{0.03, 0, 0}, {1, 0, 0, 0}}});
  const auto tool = std::make_unique<Tool>();
  const std::uint64_t before = allocations;
  for (int number = 0; number < 500; ++number) {
    scene.objects[1].placement.position_m.x -= 0.00002;
    step(scene, *tool, {.position_m = {0.024 - 0.00002 * number, 0.0001 * number, 0}});
  }
  CHECK(allocations == before);
  CHECK(tool->proxy_m.y > 0.01);
}

TEST_CASE("objects above the limit are not felt, and missing meshes and empty meshes are free space") {
  Scene scene;
  for (std::uint32_t id = 0; id < 70; ++id) {
    Object object;
    object.id = id;
    object.shape = Sphere{0.001};
    object.placement.position_m.x = id * 0.01;
    scene.objects.push_back(object);
  }
  scene.objects[0].shape = std::shared_ptr<const geometry::Surface>{};
  scene.objects[1].shape = geometry::Surface::build({});
  Hand hand(scene, 0.001, {0.63, 0, 0.01});
  hand.go_straight({0.63, 0, 0});
  CHECK(hand.last.proxy_m != hand.pose.position_m);
  for (const double x_m : {0.64, 0.0, 0.01}) {
    hand.go_straight({x_m, 0, 0.01}, 0.002);
    hand.go_straight({x_m, 0, 0});
    CHECK(hand.last.proxy_m == hand.pose.position_m);
  }
}

TEST_CASE("20,000 random paths pass no thin wall, ridge or slit") {
  const auto bodies = contact_trial::hollow_bodies();
  for (const contact_trial::HollowBody& body : bodies) CHECK(body.surface->is_solid());
  std::uint64_t touching = 0;
  double least_clearance_m = 1;
  for (std::uint64_t number = 0; number < 20000; ++number) {
    const contact_trial::PathResult result = contact_trial::run_path(bodies, number);
    CAPTURE(number);
    CHECK(!result.passed);
    touching += result.touching_steps;
    least_clearance_m = std::min(least_clearance_m, result.least_clearance_m);
  }
  CHECK(touching > 20000 * contact_trial::steps_per_path / 4);
  CHECK(least_clearance_m < 2e-6);
}

}  // namespace inkwell::contact
