#include <doctest/doctest.h>

#include <cmath>

#include "firmware/force_laws/detent_dial.hpp"
#include "firmware/force_laws/magnet.hpp"
#include "firmware/force_laws/virtual_mass.hpp"
#include "firmware/force_laws/viscous_sphere.hpp"

namespace {

using namespace inkwell;
using namespace inkwell::force_laws;

/// Steps a force law once per control period with its default parameters.
template <class Law>
struct Stepped {
  typename Law::Parameters parameters{};
  typename Law::State state{};
  typename Law::Signals signals{};
  Probe probe;

  Stepped() {
    for (const auto& row : Law::parameter_rows) parameters.*row.value = row.default_value;
    probe.wall = {800.0f, 2.0f};
  }
  Vector3 step() { return Law::force_N(probe, parameters, state, signals); }
  /// Moves the probe in a straight line and returns the last force.
  Vector3 move(const Vector3& to_m, int periods) {
    const Vector3 way_m = to_m - probe.position_m;
    const Vector3 begin_m = probe.position_m;
    probe.velocity_m_per_s = (1.0f / (static_cast<float>(periods) * protocol::servo_period_s)) * way_m;
    Vector3 force_N;
    for (int i = 1; i <= periods; ++i) {
      probe.position_m = begin_m + (static_cast<float>(i) / static_cast<float>(periods)) * way_m;
      force_N = step();
    }
    return force_N;
  }
};

TEST_CASE("a magnet pulls most at its reach, not at all where it is, and pushes if its strength is negative") {
  Stepped<magnet> law;
  const Vector3 magnet_m{law.parameters.x_m, law.parameters.y_m, law.parameters.z_m};
  law.probe.position_m = magnet_m;
  CHECK(law.step() == Vector3{});
  CHECK(law.signals.distance_m == 0.0f);
  law.probe.position_m = magnet_m + Vector3{law.parameters.reach_m, 0.0f, 0.0f};
  CHECK(law.step().x == doctest::Approx(-law.parameters.strength_N));
  CHECK(law.signals.distance_m == doctest::Approx(law.parameters.reach_m));
  for (const float part : {0.5f, 2.0f}) {
    law.probe.position_m = magnet_m + Vector3{0.0f, part * law.parameters.reach_m, 0.0f};
    CHECK(law.step().y == doctest::Approx(-0.8f * law.parameters.strength_N));
  }
  law.parameters.strength_N = -1.0f;
  CHECK(law.step().y > 0.0f);
}

TEST_CASE("a force law that uses the box walls adds the wall force") {
  Stepped<magnet> law;
  law.probe.position_m = {law.parameters.x_m, law.parameters.y_m, law.parameters.z_m};
  law.probe.walls_N = {0.8f, 0.0f, 0.0f};
  CHECK(law.step().x == doctest::Approx(0.8f));
}

TEST_CASE("a viscous sphere holds back inside of it, without a step at its skin") {
  Stepped<viscous_sphere> law;
  const Vector3 centre_m{law.parameters.x_m, law.parameters.y_m, law.parameters.z_m};
  law.probe.velocity_m_per_s = {0.1f, 0.0f, -0.2f};
  law.probe.position_m = centre_m;
  const Vector3 deep_N = law.step();
  CHECK(deep_N.x == doctest::Approx(-0.1f * law.parameters.damping_Ns_per_m));
  CHECK(deep_N.z == doctest::Approx(0.2f * law.parameters.damping_Ns_per_m));
  CHECK(law.signals.part == 1.0f);
  law.probe.position_m = centre_m + Vector3{law.parameters.radius_m - 1e-5f, 0.0f, 0.0f};
  CHECK(std::fabs(law.step().z) < 0.01f * deep_N.z);
  law.probe.position_m = centre_m + Vector3{law.parameters.radius_m + 1e-5f, 0.0f, 0.0f};
  CHECK(law.step() == Vector3{});
  law.parameters.radius_m = 0.0f;
  law.probe.position_m = centre_m;
  CHECK(law.step() == Vector3{});
}

TEST_CASE("a dial counts its notches there and back, and pulls to the middle of one") {
  Stepped<detent_dial> law;
  const float radius_m = 0.05f;
  const Vector3 begin_m{law.parameters.x_m + radius_m, law.parameters.y_m, 0.0f};
  law.probe.position_m = begin_m;
  CHECK(law.step() == Vector3{});
  // At a quarter of a notch, the force is largest and opposes the motion.
  const Vector3 quarter_m = begin_m + Vector3{0.0f, 0.25f * law.parameters.notch_m, 0.0f};
  CHECK(law.move(quarter_m, 200).y == doctest::Approx(-law.parameters.force_N).epsilon(0.01));
  law.move(begin_m + Vector3{0.0f, 0.8f * law.parameters.notch_m, 0.0f}, 400);
  CHECK(law.signals.passed_notches == 1.0f);
  // Hysteresis keeps the notch count unchanged.
  law.move(begin_m + Vector3{0.0f, 0.45f * law.parameters.notch_m, 0.0f}, 400);
  CHECK(law.signals.passed_notches == 1.0f);
  law.move(begin_m, 400);
  CHECK(law.signals.passed_notches == 0.0f);
  law.probe.position_m = {law.parameters.x_m, law.parameters.y_m, 0.0f};
  CHECK(law.step() == Vector3{});
}

TEST_CASE("generated C code retains its state: the virtual mass swings and comes to rest at the probe") {
  Stepped<virtual_mass> law;
  law.probe.position_m = {0.01f, 0.02f, 0.03f};
  CHECK(law.step() == Vector3{});
  law.probe.position_m.x += 0.005f;
  CHECK(law.step().x == doctest::Approx(-law.parameters.stiffness_N_per_m * 0.005f).epsilon(0.01));
  float fastest_m_per_s = 0.0f;
  for (int i = 0; i < 100'000; ++i) {
    law.step();
    fastest_m_per_s = std::fmax(fastest_m_per_s, law.signals.speed_m_per_s);
  }
  // Without damping the peak speed would be x sqrt(k / m).
  CHECK(fastest_m_per_s == doctest::Approx(0.005 * std::sqrt(200.0 / 0.2)).epsilon(0.15));
  CHECK(law.signals.speed_m_per_s < 1e-3f);
  law.state = {};
  law.probe.position_m = {};
  CHECK(law.step() == Vector3{});
}

}  // namespace
