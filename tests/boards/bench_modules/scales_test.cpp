// Compares the board's scale factors with values that this test computes from the components and wiring in README.md.
#include "boards/bench_modules/facts.hpp"

#include <doctest/doctest.h>
#include "tests/boards/virtual/plant/driven_plant.hpp"

namespace {

using namespace inkwell;
using doctest::Approx;

constexpr const board::Facts& facts = board::bench_modules;

TEST_CASE("bench modules: a crystal of 16 MHz, of which the PLL takes an eighth") {
  CHECK(facts.crystal_Hz == 16'000'000);
  CHECK(facts.pll_m() == 8);
}

TEST_CASE("bench modules: a heartbeat that 8.2 k and 10 nF hold for 82 us") {
  CHECK(facts.bridge_hold_s == Approx(8.2e3 * 10e-9).scale(0));
}

TEST_CASE("bench modules: bridges with a dead time of 90 ns") {
  CHECK(facts.bridge_dead_time_s == 90e-9f);
  CHECK(facts.bridge_dead_time_part() == Approx(0.0108).scale(0));
}

TEST_CASE("bench modules: 5 mohm and a gain of 50 are 0.25 V/A around 1.65 V, 310.3 counts an ampere") {
  CHECK(1.0 / facts.current_step_A() == Approx(310.303));
  CHECK(facts.current_range_A() == Approx(6.6));
  CHECK(facts.current_measurable_A() == Approx(5.51));
}

TEST_CASE("bench modules: 82 k over 10 k, 18 V are 2428 counts") {
  CHECK(18.0 / facts.supply_step_V() == Approx(2428.46));
}

TEST_CASE("bench modules: the LED is between the supply and its pin") { CHECK(facts.status_led_shines_when_low); }

TEST_CASE(
    "bench modules: the pins have the expected voltages for the supply, the potentiometers and the motor currents") {
  test::DrivenPlant driven(test::omni(), {}, facts);
  CHECK(driven.read_V(facts.supply) == Approx(18.0 / 9.2).epsilon(0.01));
  for (const auto& wiper : facts.gimbal) CHECK(driven.read_V(wiper) == Approx(1.65).epsilon(0.01));  // mid-scale
  driven.enable(true);
  driven.run(0.003, {0.2, -0.2, 0.0});
  const auto truth = driven.plant.truth(driven.now);
  REQUIRE(truth.current_A[0] > 0.8);
  REQUIRE(truth.current_A[1] < -0.8);
  for (const int motor : {0, 1})
    CHECK(driven.read_V(facts.motor_current[motor]) == Approx(1.65 + 0.25 * truth.current_A[motor]).epsilon(0.02));
  CHECK(driven.inputs.at({'B', 3}) == virtual_board::PinLevel::low);       // the stylus is in the inkwell
  CHECK(driven.inputs.at({'B', 8}) == virtual_board::PinLevel::floating);  // button not pressed
}

}  // namespace
