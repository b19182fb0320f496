#include "tests/contact/closed_loop.hpp"

#include <doctest/doctest.h>

#include "tests/contact/board_trial.hpp"
#include "tests/contact/stiffness.hpp"

namespace inkwell::closed_loop {

TEST_CASE("a mesh is stable at 90 % of the stiffness of the board's own shape") {
  for (const Body body : {Body::plane, Body::ball}) {
    CAPTURE(static_cast<int>(body));
    // With the friction of the arm, board and mesh reach the largest stiffness.
    for (const HandModel& hand : {light_hand, firm_hand})
      for (const double push_N : {1.0, 2.0})
        CHECK(rms_speed_m_per_s({body, Source::mesh, hand, push_N}, stiffness_max_N_per_m()) <= still_m_per_s);
    // Without this friction, the light hand is not stable there, and the firm hand is stable up to 2000 N/m.
    CHECK(rms_speed_m_per_s({body, Source::board, light_hand, 1, false}, stiffness_max_N_per_m()) > still_m_per_s);
    CHECK(rms_speed_m_per_s({body, Source::mesh, firm_hand, 1, false, 4}, 0.9 * 2000) <= still_m_per_s);
  }
}

TEST_CASE("the PC sends a model after 1 to 3 bus frames, and some reports are lost") {
  for (const double lost_part : {0.0, 0.2}) {
    ClosedLoop loop({.lost_part = lost_part});
    auto scene = std::make_shared<contact::Scene>();
    scene->objects.push_back({.id = 1, .shape = contact::Plane{}, .placement = {{0, 0, -0.0365}, {1, 0, 0, 0}}});
    device::Shapes materials;
    materials.materials = {{500, 0, 0, 0, 0}};
    loop.place_shapes(materials);
    loop.publish(scene);
    loop.run(2);
    CHECK(static_cast<double>(loop.models_received()) == doctest::Approx(1000 * (1 - lost_part)).epsilon(0.1));
  }
}

TEST_CASE(
    "in 90 s at thin walls, no proxy stays beyond the wall, and models of surfaces without damping do not raise the "
    "force") {
  const auto bodies = contact_trial::hollow_bodies();
  unsigned touching_periods = 0;
  for (std::uint64_t number = 0; number < 30; ++number) {
    CAPTURE(number);
    const Visit result = visit(bodies, number, 3);
    CHECK(!result.has_fallen());
    // The damper of a second surface begins with a step.
    if (result.wall != Wall::friction_and_damping) CHECK(result.rises <= 2);
    touching_periods += result.touching_periods;
  }
  CHECK(touching_periods > 30 * 3 * protocol::servo_rate_Hz / 4);
}

}  // namespace inkwell::closed_loop
