#include "host/contact/publication.hpp"

#include <doctest/doctest.h>

#include <atomic>
#include <thread>

namespace inkwell::contact {

TEST_CASE("the servo thread gets the newest scene, and the editing thread frees the old ones") {
  Publication publication;
  CHECK(publication.latest() == nullptr);
  auto first = std::make_shared<const Scene>();
  auto second = std::make_shared<const Scene>();
  const std::weak_ptr<const Scene> first_exists = first;
  const std::weak_ptr<const Scene> second_exists = second;
  const Scene* const first_address = first.get();
  publication.publish(std::move(first));
  CHECK(publication.latest() == first_address);
  CHECK(publication.latest() == first_address);
  publication.publish(std::move(second));
  CHECK(!first_exists.expired());
  publication.latest();
  // The servo thread returned the first scene and did not free it.
  CHECK(!first_exists.expired());
  publication.free_retired();
  CHECK(first_exists.expired());
  CHECK(!second_exists.expired());
}

TEST_CASE("a scene that was never used is freed by the next publication, and the rest with the publication") {
  std::weak_ptr<const Scene> unused;
  std::weak_ptr<const Scene> used;
  {
    Publication publication;
    auto scene = std::make_shared<const Scene>();
    unused = scene;
    publication.publish(std::move(scene));
    auto next = std::make_shared<const Scene>();
    used = next;
    publication.publish(std::move(next));
    CHECK(unused.expired());
    publication.latest();
    publication.publish(std::make_shared<const Scene>());
    publication.latest();
  }
  CHECK(used.expired());
}

TEST_CASE("two threads exchange scenes without losing or freeing one too early") {
  Publication publication;
  std::atomic<bool> ends{false};
  std::uint64_t decreases = 0;
  std::thread servo([&] {
    double last_m = 0;
    while (!ends) {
      const Scene* const scene = publication.latest();
      if (!scene) continue;
      const double position_m = scene->objects[0].placement.position_m.x;
      if (position_m < last_m) ++decreases;
      last_m = position_m;
    }
  });
  std::weak_ptr<const Scene> last;
  for (int number = 1; number <= 20000; ++number) {
    auto scene = std::make_shared<Scene>();
    scene->objects.emplace_back().placement.position_m.x = number;
    last = scene;
    publication.publish(std::move(scene));
  }
  ends = true;
  servo.join();
  CHECK(decreases == 0);
  CHECK(publication.latest()->objects[0].placement.position_m.x == 20000);
  CHECK(!last.expired());
}

}  // namespace inkwell::contact
