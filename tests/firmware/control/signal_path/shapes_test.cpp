#include <doctest/doctest.h>

#include "firmware/control/signal_path/shapes.hpp"

namespace {

using namespace inkwell;
using control::LivingShapes;
using control::Shapes;

TEST_CASE("without shapes nothing lives") {
  LivingShapes living;
  CHECK(!living.any());
  CHECK(!living.any_plane());
  CHECK(!living.age());
}

TEST_CASE("each shape ends after its life, and the end is reported once") {
  Shapes shapes;
  shapes.planes[0] = shapes.planes[4] = {{0.0f, 0.0f, 1.0f}, 0.01f};
  shapes.life_periods[0] = 3;
  shapes.life_periods[4] = 5;
  shapes.life_periods[Shapes::planes_maximum + 2] = 6;
  shapes.life_periods[Shapes::maximum - 1] = Shapes::lasting;
  LivingShapes living;
  living.replace(shapes);
  CHECK(living.solids() == (1u << 2 | 1u << (Shapes::solids_maximum - 1)));
  for (int period = 1; period < 9; ++period) {
    CAPTURE(period);
    CHECK(living.age() == (period == 3 || period == 5 || period == 6));
    CHECK((living.planes()[0].offset_m == 0.01f) == (period < 3));
    CHECK((living.planes()[4].offset_m == 0.01f) == (period < 5));
    CHECK(living.any_plane() == (period < 5));
    CHECK((living.solids() & 1u << 2) == (period < 6 ? 4u : 0u));
  }
  CHECK(living.any());
  const Shapes nothing;
  living.replace(nothing);
  CHECK(!living.any());
}

TEST_CASE("every point is in the free space of an unused plane") {
  LivingShapes living;
  const Shapes nothing;
  living.replace(nothing);
  for (const control::Plane& plane : living.planes()) CHECK(dot(plane.normal, {-9.0f, 9.0f, -9.0f}) > plane.offset_m);
}

}  // namespace
