#include "boards/virtual/plant/plant.hpp"

#include <cmath>

#include <doctest/doctest.h>
#include "boards/omni_driver/facts.hpp"

#include "tests/boards/virtual/plant/driven_plant.hpp"

using namespace inkwell;
using namespace inkwell::test;

TEST_CASE("the hand meter sums the energy from the arm to the hand and ignores the energy from the hand") {
  HandMeter meter;
  CHECK_FALSE(meter.runs());
  meter.start({0.0, 0.0, 0.1}, 7);
  CHECK(meter.reading().since == 7);
  meter.step({0.0, 0.0, 0.12}, {0.0, 0.0, 0.1}, {0.0, 3.0, 4.0});   // 4 N over 20 mm
  meter.step({0.0, 0.0, 0.11}, {0.0, 0.0, 0.14}, {0.0, 0.0, 4.0});  // the hand returns 40 mJ
  meter.step({0.0, 0.0, 0.11}, {0.0, 0.0, 0.11}, {0.0, 0.0, 1.0});
  CHECK(meter.reading().peak_force_N == doctest::Approx(5.0));
  CHECK(meter.reading().energy_J == doctest::Approx(0.08));
  CHECK(meter.reading().travel_m == doctest::Approx(0.02));
  CHECK(meter.reading().lag_m == doctest::Approx(0.03));
}

TEST_CASE("the hand meter of the plant measures the force and the work of the motors on a hand that holds the probe") {
  auto arm = test::frictionless(test::omni());
  arm.simulation.gravity_m_per_s2 = 0.0;
  DrivenPlant driven(arm);
  driven.plant.place(free_joints(arm), Vector3::Zero());
  const Vector3 held_m = driven.plant.truth(0).position_m;
  driven.plant.hold(held_m, 2000.0, 20.0);
  driven.idle(0.05);
  driven.plant.start_meters();
  driven.enable(true);
  driven.run(0.1, {0.1, 0.0, 0.0});
  const Truth t = driven.plant.truth(driven.now);
  const auto& reading = driven.plant.hand_meter().reading();
  const double stretched_m = (t.position_m - held_m).norm();
  CHECK(stretched_m > 0.0001);
  CHECK(reading.peak_force_N >= 0.99 * t.hand_force_N.norm());
  CHECK(reading.travel_m >= 0.99 * stretched_m);
  CHECK(reading.lag_m == doctest::Approx(reading.travel_m).scale(0).epsilon(0.02));
  // The energy is at least the energy in the spring of the hand.
  CHECK(reading.energy_J > 0.9 * 0.5 * 2000.0 * stretched_m * stretched_m);
}

TEST_CASE("the truth contains the last time at which a bridge could drive its motor") {
  DrivenPlant driven(test::omni());
  driven.run(0.001, {0.5, 0.5, 0.5});
  CHECK(driven.plant.truth(driven.now).driven_until == 0);  // not enabled
  driven.enable(true);
  driven.run(0.001, {0.5, 0.5, 0.5});
  driven.legs(PinLevel::high);
  driven.idle(0.0001);
  CHECK(driven.plant.truth(driven.now).driven_until == driven.now);
  const Ticks off = driven.now;
  driven.enable(false);
  driven.idle(0.001);
  CHECK(driven.plant.truth(driven.now).driven_until == off);
  driven.enable(true);
  driven.idle(0.001);
  const Ticks low = driven.now;
  driven.legs(PinLevel::low);  // braked, not driven
  driven.idle(0.001);
  CHECK(driven.plant.truth(driven.now).driven_until == low);
  driven.legs(PinLevel::high);
  driven.idle(0.001);
  const Ticks fault = driven.now;
  driven.plant.set_bridge_fault(true);
  driven.idle(0.001);
  CHECK(driven.plant.truth(driven.now).driven_until == fault);
}
