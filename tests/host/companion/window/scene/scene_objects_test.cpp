// Checks which changes of objects and contact points need a new picture.
#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <thread>
#include <vector>

#include <doctest/doctest.h>
#include <glm/gtc/quaternion.hpp>

#include "host/companion/window/frame/picture_digest.hpp"
#include "host/companion/window/scene/scene_objects.hpp"
#include "host/geometry/examples.hpp"

using namespace inkwell;
using window::SceneObjects;
using window::ShownObject;

namespace {

std::shared_ptr<const geometry::Mesh> box(double size_m = 0.02) {
  return std::make_shared<const geometry::Mesh>(geometry::make_box({size_m, size_m, size_m}));
}

/// Objects and contact points that the test changes.
struct Table {
  std::vector<ShownObject> objects;
  std::vector<glm::vec3> points_m;
  SceneObjects scene{[this] { return objects; }, [this] { return points_m; }};

  explicit Table(std::vector<ShownObject> at_start) : objects(std::move(at_start)) {
    scene.follow();
    wait_until_ready();
  }

  void wait_until_ready() {
    const auto is_ready = [](const window::SceneObject& object) { return object.is_ready; };
    while (!std::ranges::all_of(scene.objects(), is_ready)) {
      std::this_thread::yield();
      scene.follow();
    }
    scene.follow();
  }

  std::uint64_t digest() const {
    window::PictureDigest digest;
    scene.add_to(digest);
    return digest.value();
  }
};

}  // namespace

TEST_CASE("an unmoved object needs no new picture, and a moved or turned one does") {
  Table table({{box(), {0.01f, 0.0f, 0.0f}}});
  const std::uint64_t before = table.digest();
  CHECK_FALSE(table.scene.has_changed());
  CHECK_FALSE(table.scene.follow());
  CHECK(table.digest() == before);

  table.objects[0].position_m.x += 1e-3f;
  CHECK(table.scene.has_changed());
  CHECK(table.scene.follow());
  const std::uint64_t moved = table.digest();
  CHECK(moved != before);
  CHECK_FALSE(table.scene.has_changed());

  table.objects[0].rotation = glm::angleAxis(0.01f, glm::vec3{0.0f, 1.0f, 0.0f});
  CHECK(table.scene.has_changed());
  CHECK(table.scene.follow());
  CHECK(table.digest() != moved);
}

TEST_CASE("an invisible motion of an object does not change the picture, but the sum of such motions does") {
  Table table({{box()}});
  const std::uint64_t before = table.digest();
  bool changed = false;
  for (int step = 0; step < 5; ++step) {
    table.objects[0].position_m.z += 5e-5f;
    if (step == 0) CHECK_FALSE(table.scene.has_changed());
    changed = table.scene.follow() || changed;
    if (step == 0) CHECK(table.digest() == before);
  }
  CHECK(changed);
  CHECK(table.digest() != before);
}

TEST_CASE("a quaternion and its negative are the same rotation") {
  Table table({{box(), {}, glm::angleAxis(1.0f, glm::vec3{0.0f, 1.0f, 0.0f})}});
  table.objects[0].rotation = -table.objects[0].rotation;
  CHECK_FALSE(table.scene.has_changed());
}

TEST_CASE("a new, a different and a removed mesh change the picture") {
  Table table({});
  const std::uint64_t empty = table.digest();
  table.objects = {{box()}};
  CHECK(table.scene.has_changed());
  table.scene.follow();
  table.wait_until_ready();
  const std::uint64_t one = table.digest();
  CHECK(one != empty);
  const std::uint64_t revision = table.scene.meshes_revision();

  table.objects = {{box()}};  // the same shape in a different mesh
  table.scene.follow();
  table.wait_until_ready();
  CHECK(table.digest() != one);
  CHECK(table.scene.meshes_revision() != revision);

  table.objects.clear();
  CHECK(table.scene.follow());
  CHECK(table.digest() == empty);
}

TEST_CASE("a mesh is prepared once for all its objects and placements") {
  const auto mesh = box();
  Table table({{mesh, {0.01f, 0.0f, 0.0f}}, {mesh, {0.03f, 0.0f, 0.0f}}});
  const auto preparation = table.scene.objects()[0].preparation;
  CHECK(table.scene.objects()[1].preparation == preparation);
  const std::uint64_t revision = table.scene.meshes_revision();
  table.objects[1].position_m.y = 0.02f;
  table.scene.follow();
  CHECK(table.scene.objects()[1].preparation == preparation);
  CHECK(table.scene.objects()[1].is_ready);
  CHECK(table.scene.meshes_revision() == revision);
}

TEST_CASE("the finished preparation of a large mesh needs a new picture") {
  std::vector<ShownObject> objects{{std::make_shared<const geometry::Mesh>(geometry::make_ball(0.03, 0.0, 6))}};
  SceneObjects scene([&] { return objects; }, nullptr);
  CHECK(scene.follow());
  CHECK(scene.progress().find("81920 triangles") != std::string::npos);
  CHECK_FALSE(scene.box());
  while (!scene.has_changed()) std::this_thread::yield();
  CHECK(scene.follow());
  CHECK(scene.progress().empty());
  CHECK(scene.objects()[0].mesh().indices.size() / 3 <= window::drawn_triangles_max);
  CHECK(scene.box());
}

TEST_CASE("each change of the loading needs a frame, and a replay hides the loading") {
  window::ObjectLoading loading;
  SceneObjects scene(nullptr, nullptr, [&] { return loading; });
  CHECK_FALSE(scene.follow());
  loading.progress = "loading skull.stl: reading the mesh, 12 %";
  CHECK(scene.has_changed());
  CHECK(scene.follow());
  CHECK(scene.progress() == loading.progress);
  CHECK_FALSE(scene.has_changed());
  loading = {.problem = "skull.stl is empty."};
  CHECK(scene.has_changed());
  CHECK(scene.follow());
  CHECK(scene.progress().empty());
  CHECK(scene.problem() == "skull.stl is empty.");
  CHECK(scene.follow(true));
  CHECK(scene.problem().empty());
}

TEST_CASE("contact points appear, move and disappear without a new picture of the objects") {
  Table table({{box()}});
  const std::uint64_t before = table.digest();
  for (const auto& points_m : {std::vector<glm::vec3>{{0.0f, 0.0f, 0.0f}}, {{0.001f, 0.0f, 0.0f}}, {}}) {
    table.points_m = points_m;
    CHECK(table.scene.has_changed());
    CHECK(table.scene.follow());
    CHECK(table.scene.contact_points_m().size() == points_m.size());
    CHECK_FALSE(table.scene.has_changed());
  }
  CHECK(table.digest() == before);
}

TEST_CASE("the box of the scene contains rotated objects") {
  Table table({{box(0.02), {0.1f, 0.0f, 0.0f}, glm::angleAxis(0.7853982f, glm::vec3{0.0f, 0.0f, 1.0f})}});
  const auto bounds = table.scene.box();
  REQUIRE(bounds);
  CHECK(bounds->maximum_m.x == doctest::Approx(0.1 + 0.01 * std::sqrt(2.0)));
  CHECK(bounds->minimum_m.z == doctest::Approx(-0.01));
}

TEST_CASE("hidden objects are not in the scene") {
  Table table({{box()}});
  table.points_m = {{0.0f, 0.0f, 0.0f}};
  table.scene.follow();
  CHECK(table.scene.follow(true));
  CHECK(table.scene.objects().empty());
  CHECK(table.scene.contact_points_m().empty());
  CHECK_FALSE(table.scene.box());
}

TEST_CASE("objects without a mesh or without a valid placement, and invalid points, are ignored") {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  Table table({{nullptr}, {box(), {nan, 0.0f, 0.0f}}, {box(), {}, glm::quat{nan, 0.0f, 0.0f, 0.0f}}});
  table.points_m = {{0.0f, nan, 0.0f}};
  CHECK(table.scene.objects().empty());
  CHECK_FALSE(table.scene.has_changed());
}

TEST_CASE("without functions, the scene has no objects") {
  SceneObjects scene(nullptr, nullptr);
  CHECK_FALSE(scene.has_changed());
  CHECK_FALSE(scene.follow());
  CHECK(scene.progress().empty());
}
