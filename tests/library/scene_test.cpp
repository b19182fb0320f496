// Scenes: objects of a program are felt, move, are changed and removed, and bad input changes nothing.
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include <inkwell/inkwell.hpp>
#include "host/geometry/examples.hpp"
#include "tests/dropins/board.hpp"

#include "tests/library/virtual_arm.hpp"

namespace inkwell::tests {
namespace {

constexpr double ball_radius_m = 0.02, tip_radius_m = 0.005, ball_z_m = -0.06, stiffness_N_per_m = 1000;
/// The hand pulls the tip 7 mm below its position on top of the ball.
constexpr double pressed_m[3]{0, 0, ball_z_m + ball_radius_m + tip_radius_m - 0.007};
/// Force between the springs of the hand and of the ball.
constexpr double pressed_N = 0.007 * hand_N_per_m * stiffness_N_per_m / (hand_N_per_m + stiffness_N_per_m);
/// The friction of the simulated arm holds back a part of the force.
constexpr double friction_N = 0.15;

using Vertices = std::vector<std::array<float, 3>>;
using Triangles = std::vector<std::array<std::uint32_t, 3>>;

struct BallMesh {
  Vertices vertices_m;
  Triangles triangles;
  BallMesh() {
    const auto mesh = geometry::make_ball(ball_radius_m, 0, 3);
    for (const auto& vertex : mesh.vertices_m) vertices_m.push_back({vertex.x, vertex.y, vertex.z});
    triangles.assign(mesh.faces.begin(), mesh.faces.end());
  }
  Object object() const {
    Object object = make_mesh(vertices_m, triangles);
    place(object);
    return object;
  }
  static void place(Object& object) {
    object.placement.position_m[2] = ball_z_m;
    object.material.stiffness_N_per_m = stiffness_N_per_m;
    object.material.damping_Ns_per_m = 2;
  }
};

Object solid_ball() {
  Object object = make_object(INKWELL_SHAPE_SPHERE, {ball_radius_m});
  BallMesh::place(object);
  return object;
}

struct SceneArm : VirtualArm {
  SceneArm() : VirtualArm("virtual?seed=1") {}
  /// Switches the force on, and lets the hand rest at the free point.
  void make_active() {
    VirtualArm::make_active();
    rest();
  }
  void lift() {
    REQUIRE(inkwell_move_virtual_hand(arm, free_point_m, hand_N_per_m) == INKWELL_OK);
    rest();
  }
  std::uint32_t add(const Object& object) {
    std::uint32_t number = 0;
    const auto result = inkwell_scene_add(arm, &object, sizeof object, &number);
    REQUIRE_MESSAGE(result == INKWELL_OK, std::string(inkwell_error_text()));
    return number;
  }
  inkwell_pose press() {
    REQUIRE(inkwell_move_virtual_hand(arm, pressed_m, hand_N_per_m) == INKWELL_OK);
    return rest();
  }
  inkwell_pose rest() {
    REQUIRE(inkwell_sleep(arm, 0.3) == INKWELL_OK);
    inkwell_pose pose;
    REQUIRE(inkwell_get_pose(arm, &pose) == INKWELL_OK);
    return pose;
  }
  std::vector<Contact> contacts() {
    std::vector<Contact> all(INKWELL_CONTACTS_MAXIMUM);
    std::size_t count = 0;
    REQUIRE(inkwell_scene_get_contacts(arm, all.data(), sizeof(Contact), all.size(), &count) == INKWELL_OK);
    all.resize(count);
    return all;
  }
  std::vector<Event> events() {
    std::vector<Event> all(100);
    std::size_t count = 0;
    REQUIRE(inkwell_scene_read_events(arm, all.data(), sizeof(Event), all.size(), &count, nullptr) == INKWELL_OK);
    all.resize(count);
    return all;
  }
};

double length(const double (&vector)[3]) { return std::hypot(vector[0], vector[1], vector[2]); }

TEST_CASE("a mesh ball is felt: force, and contact with point, normal, object and triangle") {
  SceneArm arm;
  BallMesh ball;
  std::uint32_t number = 0;
  SUBCASE("added before the force is on") {
    number = arm.add(ball.object());
    arm.make_active();
  }
  SUBCASE("added while the force is on") {
    arm.make_active();
    number = arm.add(ball.object());
  }
  SUBCASE("turned inside out, with degenerate triangles in front, from doubles and 64-bit indices") {
    std::vector<std::array<double, 3>> vertices_m;
    for (const auto& vertex : ball.vertices_m) vertices_m.push_back({vertex[0], vertex[1], vertex[2]});
    std::vector<std::array<std::int64_t, 3>> triangles;
    for (const auto& face : ball.triangles) triangles.push_back({face[0], face[2], face[1]});
    triangles.insert(triangles.begin(), 5, {0, 0, 1});
    ball.triangles.insert(ball.triangles.begin(), 5, {0, 0, 1});
    Object object = make_mesh(vertices_m, triangles);
    BallMesh::place(object);
    number = arm.add(object);
    arm.make_active();
  }
  const inkwell_pose pose = arm.press();
  CHECK(std::abs(pose.force_N[2] - pressed_N) < friction_N);
  CHECK((pose.force_sources & INKWELL_SHAPES) != 0);
  const auto contacts = arm.contacts();
  REQUIRE(!contacts.empty());
  const Contact& contact = contacts[0];
  CHECK(contact.object == number);
  CHECK(contact.normal[2] > 0.98);
  CHECK(std::abs(contact.point_m[2] - (ball_z_m + ball_radius_m)) < 0.0005);
  CHECK(std::hypot(contact.point_m[0], contact.point_m[1]) < 0.003);
  CHECK(contact.depth_m == doctest::Approx(pressed_N / stiffness_N_per_m).scale(0).epsilon(0.1));
  CHECK(contact.time_s == doctest::Approx(pose.time_s).epsilon(1e-9));
  // The contact is within the triangle, whose edges are about 3 mm long.
  for (const std::uint32_t corner : ball.triangles.at(contact.triangle)) {
    const auto& vertex_m = ball.vertices_m[corner];
    CHECK(std::hypot(vertex_m[0] - contact.point_m[0], vertex_m[1] - contact.point_m[1],
                     vertex_m[2] + ball_z_m - contact.point_m[2]) < 0.004);
  }
  REQUIRE(inkwell_scene_remove(arm.arm, number) == INKWELL_OK);
  CHECK(length(arm.rest().force_N) < 1e-6);
  CHECK(arm.contacts().empty());
  CHECK(inkwell_scene_remove(arm.arm, number) == INKWELL_BAD_ARGUMENT);
  CHECK(says("does not contain object"));
}

TEST_CASE("each primitive is felt, with its material, which can be changed") {
  struct Case {
    inkwell_shape shape;
    Vector size_m;
    double top_m;  ///< above the object's origin
  };
  SceneArm arm;
  arm.make_active();
  for (const Case& each :
       {Case{INKWELL_SHAPE_SPHERE, {0.02}, 0.02}, Case{INKWELL_SHAPE_BOX, {0.02, 0.03, 0.015}, 0.015},
        Case{INKWELL_SHAPE_CYLINDER, {0.02, 0.015}, 0.015}, Case{INKWELL_SHAPE_CAPSULE, {0.02, 0.005}, 0.025},
        Case{INKWELL_SHAPE_HALF_SPACE, {}, 0.0}}) {
    CAPTURE(static_cast<int>(each.shape));
    arm.lift();
    Object object = make_object(each.shape, each.size_m);
    BallMesh::place(object);
    object.placement.position_m[2] = ball_z_m + ball_radius_m - each.top_m;
    const auto number = arm.add(object);
    CHECK(std::abs(arm.press().force_N[2] - pressed_N) < friction_N);
    Material soft{};
    REQUIRE(inkwell_find_material("sponge", &soft) == INKWELL_OK);
    CHECK(soft.viscosity_Ns_per_m > 0);
    REQUIRE(inkwell_scene_set_material(arm.arm, number, &soft) == INKWELL_OK);
    const double soft_N = 0.007 * hand_N_per_m * soft.stiffness_N_per_m / (hand_N_per_m + soft.stiffness_N_per_m);
    CHECK(std::abs(arm.rest().force_N[2] - soft_N) < friction_N);
    REQUIRE(inkwell_scene_clear(arm.arm) == INKWELL_OK);
  }
}

TEST_CASE("a moving ball pushes the hand, stops 20 ms after the last call, and a turned object turns its surface") {
  SceneArm arm;
  arm.make_active();
  Object object = solid_ball();
  object.placement.position_m[2] = -0.09;
  const auto number = arm.add(object);
  constexpr double speed_m_per_s = 0.08, start_m = -0.09;
  const double begin_s = arm.rest().time_s;
  Placement placement = object.placement;
  placement.velocity_m_per_s[2] = speed_m_per_s;
  double step_s = 0;
  double least_N = 1e9, largest_N = 0;
  SUBCASE("with a call for each pose") { step_s = 0.001; }
  SUBCASE("with 60 calls per second") { step_s = 0.0167; }
  double next_s = 0;
  const auto pose = arm.wait_until([&](const auto& now) {
    const double time_s = now.time_s - begin_s;
    if (time_s >= next_s) {
      placement.position_m[2] = start_m + speed_m_per_s * time_s;
      REQUIRE(inkwell_scene_move(arm.arm, number, &placement) == INKWELL_OK);
      next_s += step_s;
    }
    if (time_s > 0.47) {
      least_N = std::min(least_N, now.force_N[2]);
      largest_N = std::max(largest_N, now.force_N[2]);
    }
    return time_s > 0.5;
  });
  CHECK(pose.force_N[2] > 0.5);
  CHECK(pose.position_m[2] > free_point_m[2] + 0.001);
  CHECK(largest_N - least_N < 0.8);  // rises slowly, without steps between the calls
  REQUIRE(arm.contacts().size() == 1);
  arm.rest();
  const auto contacts = arm.contacts();
  REQUIRE(contacts.size() == 1);
  const double top_m = placement.position_m[2] + ball_radius_m;
  CHECK(contacts[0].point_m[2] > top_m + 0.5 * 0.020 * speed_m_per_s);
  CHECK(contacts[0].point_m[2] < top_m + 1.05 * 0.020 * speed_m_per_s);

  // A box whose edge points upward after a turn by 45 degrees about x.
  REQUIRE(inkwell_scene_clear(arm.arm) == INKWELL_OK);
  REQUIRE(inkwell_move_virtual_hand(arm.arm, free_point_m, hand_N_per_m) == INKWELL_OK);
  CHECK(length(arm.rest().force_N) < 1e-6);
  object = make_object(INKWELL_SHAPE_BOX, {0.03, 0.014, 0.014});
  BallMesh::place(object);
  const double half_turn_rad = 0.7853981634 / 2;
  object.placement.quaternion[0] = std::sin(half_turn_rad);
  object.placement.quaternion[3] = std::cos(half_turn_rad);
  arm.add(object);
  CHECK(arm.press().force_N[2] > 0.3);
}

TEST_CASE("touches and buttons are events with board time") {
  SceneArm arm;
  const auto number = arm.add(solid_ball());
  arm.make_active();
  CHECK(arm.events().empty());
  const double begin_s = arm.rest().time_s;
  arm.press();
  auto events = arm.events();
  REQUIRE(events.size() == 1);
  CHECK(events[0].kind == INKWELL_TOUCHED);
  CHECK(events[0].contact.object == number);
  CHECK(events[0].contact.normal[2] > 0.9);
  CHECK(events[0].contact.time_s == events[0].time_s);
  CHECK(events[0].time_s > begin_s);
  REQUIRE(inkwell_press_virtual_buttons(arm.arm, 0, 1) == INKWELL_OK);
  arm.rest();
  REQUIRE(inkwell_press_virtual_buttons(arm.arm, 0, 0) == INKWELL_OK);
  arm.rest();
  arm.lift();
  std::size_t count = 0;
  std::uint64_t lost = 1;
  Event first{};
  REQUIRE(inkwell_scene_read_events(arm.arm, &first, sizeof first, 1, &count, &lost) == INKWELL_OK);
  CHECK(count == 1);
  CHECK(lost == 0);
  CHECK(first.kind == INKWELL_PRESSED);
  CHECK(first.button == 2);
  CHECK(first.contact.object == number);
  events = arm.events();
  REQUIRE(events.size() == 2);
  CHECK(events[0].kind == INKWELL_RELEASED);
  CHECK(events[1].kind == INKWELL_LEFT);
  CHECK(events[1].contact.object == number);
  CHECK(events[1].time_s - events[1].contact.time_s == doctest::Approx(0.005).epsilon(0.01));
  CHECK(arm.events().empty());
  // The end of the force ends a touch.
  arm.press();
  REQUIRE(inkwell_disable_force(arm.arm) == INKWELL_OK);
  arm.rest();
  events = arm.events();
  REQUIRE(events.size() == 2);
  CHECK(events[1].kind == INKWELL_LEFT);
  CHECK(arm.contacts().empty());
}

TEST_CASE("a scene adds its force to forces and shapes of the program, and outlives a claim") {
  SceneArm arm;
  arm.make_active();
  const inkwell_plane wall{{0.004, 0, 0}, {-1, 0, 0}, {1000, 2, 0, 0, std::numeric_limits<double>::infinity()}};
  REQUIRE(inkwell_place_shapes(arm.arm, &wall, 1, nullptr) == INKWELL_OK);
  arm.add(solid_ball());  // sends materials, which must not remove the plane
  const double beside_m[3]{0.009, 0, free_point_m[2]};
  REQUIRE(inkwell_move_virtual_hand(arm.arm, beside_m, hand_N_per_m) == INKWELL_OK);
  CHECK(arm.rest().force_N[0] < -0.8);
  REQUIRE(inkwell_place_shapes(arm.arm, nullptr, 0, nullptr) == INKWELL_OK);

  // A servo and a slow loop add forces.
  arm.press();
  const auto push = [](inkwell_arm*, const inkwell_pose*, double force_N[3], void*) {
    force_N[1] = 0.4;
    return 0;
  };
  REQUIRE(inkwell_start_servo(arm.arm, push, nullptr) == INKWELL_OK);
  auto pose = arm.rest();
  CHECK(pose.force_sources == (INKWELL_SHAPES | INKWELL_PROGRAM));
  CHECK(pose.force_N[2] > 1);
  REQUIRE(inkwell_stop_servo(arm.arm) == INKWELL_OK);
  CHECK((arm.rest().force_sources & INKWELL_PROGRAM) == 0);
  const double push_N[3]{0, 0.4, 0};
  bool was_gone = false;
  const double begin_s = pose.time_s;
  double next_s = begin_s;
  arm.wait_until([&](const auto& now) {
    if (now.time_s >= next_s) {
      REQUIRE(inkwell_set_force(arm.arm, push_N) == INKWELL_OK);
      next_s = now.time_s + 0.1;
    }
    if (now.time_s > begin_s + 0.6) was_gone = was_gone || (now.force_sources & INKWELL_PROGRAM) == 0;
    return now.time_s > begin_s + 1.5;
  });
  CHECK_FALSE(was_gone);
  // The models do not extend the life of the force.
  CHECK(arm.wait_until([&](const auto& now) { return (now.force_sources & INKWELL_PROGRAM) == 0; }).force_N[2] > 1);

  inkwell_losses losses;
  inkwell_information information;
  REQUIRE(inkwell_get_information(arm.arm, &information) == INKWELL_OK);
  CHECK(information.force_reports_refused == 0);
  REQUIRE(inkwell_get_losses(arm.arm, &losses) == INKWELL_OK);
  CHECK(losses.poses == 0);

  REQUIRE(inkwell_release(arm.arm) == INKWELL_OK);
  CHECK(arm.contacts().empty());
  arm.lift();
  REQUIRE(inkwell_enable_force(arm.arm, 30) == INKWELL_OK);
  CHECK(std::abs(arm.press().force_N[2] - pressed_N) < friction_N);
  // A changed tip radius applies.
  const char* const name = "sphere_radius_m";
  const double none_m = 0;
  arm.lift();
  REQUIRE(inkwell_set_parameters(arm.arm, &name, &none_m, 1) == INKWELL_OK);
  const double smaller_N = pressed_N * (0.007 - 0.0045) / 0.007;
  CHECK(std::abs(arm.press().force_N[2] - smaller_N) < friction_N);
}

TEST_CASE("bad input is an error with a sentence, and changes nothing") {
  SceneArm arm;
  arm.make_active();
  const BallMesh ball;
  std::uint32_t number = 77;
  const auto refuses = [&](const Object& object, const std::string& words, std::size_t size = sizeof(Object)) {
    CAPTURE(words);
    CHECK(inkwell_scene_add(arm.arm, &object, size, &number) == INKWELL_BAD_ARGUMENT);
    CHECK_MESSAGE(says(words), std::string(inkwell_error_text()));
    CHECK(number == 77);
  };
  const auto changed = [&](const std::function<void(Object&)>& change) {
    Object object = ball.object();
    change(object);
    return object;
  };
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  Vertices bad_vertices_m = ball.vertices_m;
  bad_vertices_m[3][1] = std::numeric_limits<float>::quiet_NaN();
  refuses(make_mesh(bad_vertices_m, ball.triangles), "A coordinate of vertex 3 is nan m");
  bad_vertices_m[3][1] = 11;
  refuses(make_mesh(bad_vertices_m, ball.triangles), "A coordinate of vertex 3 is 11 m");
  Triangles bad_triangles = ball.triangles;
  bad_triangles[7][2] = static_cast<std::uint32_t>(ball.vertices_m.size());
  refuses(make_mesh(ball.vertices_m, bad_triangles), "Triangle 7 has the vertex");
  refuses(make_mesh(ball.vertices_m, std::vector<std::array<int, 3>>{{0, 1, -1}}), "Triangle 0 has the vertex -1");
  refuses(make_mesh(ball.vertices_m, Triangles{}), "The mesh is empty");
  refuses(make_mesh(Vertices{}, ball.triangles), "The mesh is empty");
  refuses(make_mesh(ball.vertices_m, Triangles{{1, 1, 2}}), "only triangles without area");
  refuses(changed([](Object& object) { object.mesh.vertex_type = INKWELL_INT32; }), "vertices have no known type");
  refuses(changed([](Object& object) { object.mesh.triangle_type = INKWELL_FLOAT64; }), "triangles have no known type");
  refuses(changed([](Object& object) { object.mesh.triangle_count = 200'000'000; }), "at most 100000000 triangles");
  refuses(changed([](Object& object) { object.shape = static_cast<inkwell_shape>(9); }), "9 is not a shape");
  refuses(changed([](Object& object) { object.placement.position_m[0] = nan; }), "A coordinate of the object");
  refuses(changed([](Object& object) { object.placement.quaternion[0] = nan; }), "not a rotation");
  refuses(changed([](Object& object) { object.placement.velocity_m_per_s[0] = 1e9; }), "A velocity of the object");
  refuses(changed([](Object& object) { object.material.stiffness_N_per_m = -1; }), "The stiffness");
  refuses(changed([](Object& object) { object.material.dynamic_friction = nan; }), "The dynamic friction");
  refuses(make_object(INKWELL_SHAPE_SPHERE, {0}), "A size of the object is 0 m");
  refuses(make_object(INKWELL_SHAPE_BOX, {0.1, 0.1, nan}), "A size of the object is nan m");
  refuses(ball.object(), "sizeof(inkwell_object)", sizeof(Object) - 8);
  CHECK(inkwell_scene_add(arm.arm, nullptr, sizeof(Object), &number) == INKWELL_BAD_ARGUMENT);
  const Object object = ball.object();
  CHECK(inkwell_scene_add(nullptr, &object, sizeof object, &number) == INKWELL_BAD_ARGUMENT);
  CHECK(inkwell_scene_add(arm.arm, &object, sizeof object, nullptr) == INKWELL_BAD_ARGUMENT);
  CHECK(inkwell_scene_move(arm.arm, 1, &object.placement) == INKWELL_BAD_ARGUMENT);
  CHECK(inkwell_scene_set_material(arm.arm, 1, &object.material) == INKWELL_BAD_ARGUMENT);
  Material material{};
  CHECK(inkwell_find_material("soap", &material) == INKWELL_BAD_ARGUMENT);
  CHECK(says("wood, rubber"));
  std::size_t count = 0;
  CHECK(inkwell_scene_get_contacts(arm.arm, nullptr, sizeof(Contact), 1, &count) == INKWELL_BAD_ARGUMENT);
  CHECK(inkwell_scene_get_contacts(arm.arm, nullptr, 8, 0, &count) == INKWELL_BAD_ARGUMENT);
  CHECK(inkwell_scene_read_events(arm.arm, nullptr, 8, 0, &count, nullptr) == INKWELL_BAD_ARGUMENT);
  CHECK(length(arm.press().force_N) < 1e-6);

  arm.lift();
  const auto added = arm.add(solid_ball());
  Placement nowhere{};
  nowhere.position_m[1] = nan;
  CHECK(inkwell_scene_move(arm.arm, added, &nowhere) == INKWELL_BAD_ARGUMENT);
  material.stiffness_N_per_m = 1e6;
  CHECK(inkwell_scene_set_material(arm.arm, added, &material) == INKWELL_BAD_ARGUMENT);
  CHECK(std::abs(arm.press().force_N[2] - pressed_N) < friction_N);
}

TEST_CASE("a scene has at most 64 objects and 16 materials, and reuses the materials of removed objects") {
  SceneArm arm;
  Object far = make_object(INKWELL_SHAPE_SPHERE, {0.001});
  far.placement.position_m[1] = 1;
  std::vector<std::uint32_t> numbers;
  for (int material = 0; material < INKWELL_MATERIALS_MAXIMUM; ++material) {
    far.material.stiffness_N_per_m = 100 + material;
    numbers.push_back(arm.add(far));
  }
  CHECK(numbers.back() == INKWELL_MATERIALS_MAXIMUM);
  std::uint32_t number = 0;
  far.material.stiffness_N_per_m = 99;
  CHECK(inkwell_scene_add(arm.arm, &far, sizeof far, &number) == INKWELL_REFUSED);
  CHECK(says("16 different materials"));
  REQUIRE(inkwell_scene_set_material(arm.arm, numbers[0], &far.material) == INKWELL_OK);
  REQUIRE(inkwell_scene_remove(arm.arm, numbers[1]) == INKWELL_OK);
  far.material.stiffness_N_per_m = 98;
  CHECK(arm.add(far) > numbers.back());
  for (std::size_t count = INKWELL_MATERIALS_MAXIMUM; count < INKWELL_OBJECTS_MAXIMUM; ++count) arm.add(far);
  CHECK(inkwell_scene_add(arm.arm, &far, sizeof far, &number) == INKWELL_REFUSED);
  CHECK(says("64 objects"));
}

TEST_CASE("solids and viscosity: the board renders each solid, and bad solids change nothing") {
  SceneArm virtual_arm;
  virtual_arm.make_active();
  struct Case {
    inkwell_shape shape;
    std::array<double, 3> size_m;
    double top_m;
  };
  const double top_m = -0.04;  // the probe is a point for solids of the board
  const double below_m[3]{0, 0, top_m - 0.007};
  for (const Case& each :
       {Case{INKWELL_SHAPE_SPHERE, {0.02}, 0.02}, Case{INKWELL_SHAPE_BOX, {0.02, 0.03, 0.015}, 0.015},
        Case{INKWELL_SHAPE_CYLINDER, {0.02, 0.015}, 0.015}, Case{INKWELL_SHAPE_CAPSULE, {0.02, 0.005}, 0.025}}) {
    CAPTURE(static_cast<int>(each.shape));
    Solid solid{};
    solid.shape = each.shape;
    std::ranges::copy(each.size_m, solid.size_m);
    solid.centre_m[2] = top_m - each.top_m;
    solid.surface = {stiffness_N_per_m, 2, 0, 0, std::numeric_limits<double>::infinity()};
    solid.viscosity_Ns_per_m = 2;
    virtual_arm.lift();
    inkwell_shapes shapes{};
    shapes.solids = &solid;
    shapes.solid_count = 1;
    shapes.solid_size = sizeof solid;
    REQUIRE(inkwell_place_all_shapes(virtual_arm.arm, nullptr, sizeof shapes) == INKWELL_BAD_ARGUMENT);
    REQUIRE(inkwell_place_all_shapes(virtual_arm.arm, &shapes, sizeof shapes) == INKWELL_OK);
    REQUIRE(inkwell_move_virtual_hand(virtual_arm.arm, below_m, hand_N_per_m) == INKWELL_OK);
    const auto pose = virtual_arm.rest();
    CHECK((pose.force_sources & INKWELL_SHAPES) != 0);
    CHECK(std::abs(pose.force_N[2] - pressed_N) < friction_N);
    solid.quaternion[1] = std::numeric_limits<double>::quiet_NaN();
    CHECK(inkwell_place_all_shapes(virtual_arm.arm, &shapes, sizeof shapes) == INKWELL_BAD_ARGUMENT);
    CHECK(says("orientation of solid 0"));
    solid = {};
    solid.shape = INKWELL_SHAPE_MESH;
    solid.surface.life_s = 1;
    CHECK(inkwell_place_all_shapes(virtual_arm.arm, &shapes, sizeof shapes) == INKWELL_BAD_ARGUMENT);
    CHECK(says("no solid of kind 4"));
    shapes.solid_count = INKWELL_SOLIDS_MAXIMUM + 1;
    CHECK(inkwell_place_all_shapes(virtual_arm.arm, &shapes, sizeof shapes) == INKWELL_BAD_ARGUMENT);
    CHECK(says("17 solids are too many"));
    CHECK((virtual_arm.rest().force_sources & INKWELL_SHAPES) != 0);
  }
}

/// Mean force along x while the probe slides along x on a plane with this viscosity.
double sliding_force_N(double viscosity_Ns_per_m) {
  SceneArm arm;
  arm.make_active();
  const inkwell_plane floor{{0, 0, -0.035}, {0, 0, 1}, {1000, 2, 0, 0, std::numeric_limits<double>::infinity()}};
  inkwell_shapes shapes{};
  shapes.planes = &floor;
  shapes.plane_count = 1;
  shapes.plane_viscosity_Ns_per_m = &viscosity_Ns_per_m;
  REQUIRE(inkwell_place_all_shapes(arm.arm, &shapes, sizeof shapes) == INKWELL_OK);
  const double low_m[3]{-0.02, 0, -0.045};
  REQUIRE(inkwell_move_virtual_hand(arm.arm, low_m, hand_N_per_m) == INKWELL_OK);
  const double begin_s = arm.rest().time_s;
  const inkwell_waypoint path[]{{0.01, {-0.02, 0, -0.045}}, {0.5, {0.02, 0, -0.045}}};
  REQUIRE(inkwell_move_virtual_hand_along(arm.arm, path, 2) == INKWELL_OK);
  double sum_N = 0;
  int count = 0;
  arm.wait_until([&](const auto& now) {
    if (now.time_s > begin_s + 0.15 && now.time_s < begin_s + 0.35) sum_N += now.force_N[0], ++count;
    return now.time_s > begin_s + 0.4;
  });
  return sum_N / count;
}

TEST_CASE("the viscosity of a plane brakes a sliding probe") {
  CHECK(std::abs(sliding_force_N(0)) < 0.02);
  CHECK(sliding_force_N(3) < -0.15);
}

TEST_CASE("C++: a scene from vectors, contacts and events") {
  Arm arm("virtual?seed=1");
  REQUIRE(set_patience(arm.get()) == INKWELL_OK);
  arm.move_virtual_hand({0, 0, -0.03}, hand_N_per_m);
  arm.sleep(0.5);
  arm.enable_force(30);
  const BallMesh ball;
  Object object = ball.object();
  object.material = find_material("wood");
  const std::uint32_t number = arm.scene_add(object);
  arm.move_virtual_hand({pressed_m[0], pressed_m[1], pressed_m[2]}, hand_N_per_m);
  arm.sleep(0.4);
  REQUIRE(!arm.scene_contacts().empty());
  CHECK(arm.scene_contacts()[0].object == number);
  REQUIRE(!arm.scene_read_events().empty());
  CHECK(arm.scene_read_events().empty());
  arm.scene_set_material(number, find_material("ice"));
  arm.scene_move(number, Placement{});
  arm.scene_remove(number);
  arm.scene_clear();
  arm.sleep(0.01);
  CHECK(arm.scene_contacts().empty());
  CHECK_THROWS_AS(arm.scene_remove(number), Failure);
  CHECK_THROWS_AS(find_material("soap"), Failure);
  CHECK_NOTHROW(arm.place_all_shapes({}, {}));
}

}  // namespace
}  // namespace inkwell::tests
