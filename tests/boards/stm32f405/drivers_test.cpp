// Tests of firmware drivers on the virtual chip.
#include <doctest/doctest.h>

#include "tests/boards/stm32f405/chip_fixture.hpp"

using namespace inkwell::virtual_board;
using namespace inkwell::virtual_board::test;

namespace {

constexpr double control_period_s = 50e-6;

struct SlowConversions : ChipUnderTest {
  SlowConversions() : ChipUnderTest("slow_conversions", Mode::fast) {
    show(18.0, 0.25);
    chip.input_pins().drive('B', 12, PinLevel::high);
    chip.input_pins().drive('A', 6, PinLevel::high);
  }
  void show(double supply_V, double gimbal_ratio) {
    circuit.voltages = {{{'B', 0}, supply_V / 11.0}, {{'C', 3}, gimbal_ratio * 3.3}};
  }
  void run_to_period(std::uint32_t period) {
    for (int i = 0; i < 1'000 && result(1) < period; ++i) run_for(control_period_s);
    REQUIRE(result(1) >= period);
  }
  void check_shown(double supply_V, double gimbal_ratio) {
    CHECK(result(4) == doctest::Approx(1000 * supply_V).epsilon(0.002));
    CHECK(result(5) == doctest::Approx(1000 * gimbal_ratio).epsilon(0.002));
    CHECK(result(8) == doctest::Approx(supply_V / 11 / 3.3 * 4096).epsilon(0.002));
  }
};

}  // namespace

TEST_CASE("supply and gimbal are measured again after an overrun and after an error of their transfer") {
  SlowConversions test;
  test.run_to_period(90);
  REQUIRE(test.result(0) == finished);
  CHECK(test.result(2) == 1);  // the first period, which starts the conversions
  test.check_shown(18.0, 0.25);

  test.show(15.0, 0.5);
  test.run_to_period(120);  // the stream was stopped in period 100
  CHECK(test.result(2) > 2);
  CHECK(test.result(2) < 10);
  CHECK(test.result(3) == 0);
  test.check_shown(15.0, 0.5);

  test.show(21.0, 0.75);
  test.run_to_period(220);  // the transfer failed in period 200
  CHECK(test.result(2) < 10);
  CHECK(test.result(3) == 0);
  test.check_shown(21.0, 0.75);
}

TEST_CASE("the internal reference reads less of a VDDA that is higher, and its calibration is read for 3.3 V") {
  constexpr double counts_V = 1.19 * 4096;  // of the virtual chip's internal reference
  SlowConversions test;
  for (const double analog_supply_V : {3.3, 3.0, 3.6}) {
    CAPTURE(analog_supply_V);
    test.chip.set_analog_supply_V(analog_supply_V);
    test.run_to_period(test.result(1) + 5);
    CHECK(test.result(6) == doctest::Approx(counts_V / analog_supply_V).epsilon(0.001));
    CHECK(test.result(7) == doctest::Approx(counts_V / 3.3).epsilon(0.001));
  }
  // VDDA follows the chip's supply.
  test.chip.set_supply_V(3.1);
  test.run_to_period(test.result(1) + 5);
  CHECK(test.result(6) == doctest::Approx(counts_V / 3.1).epsilon(0.001));
}

TEST_CASE("an interrupt between the check and the sleep instruction ends the sleep immediately") {
  for (const Mode mode : {Mode::exact, Mode::fast}) {
    CAPTURE(static_cast<int>(mode));
    ChipUnderTest test("sleep", mode);
    test.run_for(0.0005);
    CHECK(test.result(0) == finished);
    CHECK(test.result(1) == 1);
  }
}
