// Tests an injected fault: thread mode stalls, but the processor still handles exceptions.
#include "tests/boards/stm32f405/chip_fixture.hpp"

using namespace inkwell::virtual_board;
using namespace inkwell::virtual_board::test;

namespace {

struct Looping : ChipUnderTest {
  Looping() : ChipUnderTest("held_exceptions") {
    run_for(0.001);
    REQUIRE(result(0) == finished);
  }
  void run_to(std::uint32_t mark) {
    while (result(3) == mark) run_for(1e-6);
    while (result(3) != mark) run_for(1e-6);
    run_for(20e-6);
  }
  std::uint32_t handled() { return result(1); }
  std::uint32_t looped() { return result(2); }
};

}  // namespace

TEST_SUITE("virtual chip: stalled thread") {
  TEST_CASE("a stalled thread stops for the requested time while exceptions continue, and then continues") {
    Looping test;
    test.run_to(1);
    const auto handled = test.handled(), looped = test.looped();
    test.chip.stall_thread(ticks(0.01));
    test.run_for(0.0099);
    CHECK(test.looped() == looped);
    CHECK(test.handled() == doctest::Approx(handled + 158).epsilon(0.02));  // at 16 MHz
    test.run_for(0.0002);
    CHECK(test.looped() > looped);
  }

  TEST_CASE("a stalled thread continues while exceptions are masked, and stops afterwards") {
    for (const std::uint32_t holds : {2, 4}) {
      CAPTURE(holds);
      Looping test;
      test.run_to(holds);
      const auto handled = test.handled();
      test.chip.stall_thread(ticks(0.1));
      test.run_for(0.01);
      CHECK(test.result(3) == holds);
      CHECK(test.handled() > handled + 100);
      const auto looped = test.looped();
      CHECK(looped % 1000 == 0);  // the stall lasts until the masking section ends
      test.run_for(0.01);
      CHECK(test.looped() == looped);
    }
  }

  TEST_CASE("a reset ends it") {
    Looping test;
    test.chip.stall_thread(ticks(1.0));
    test.chip.reset();
    test.run_for(0.001);
    const auto looped = test.looped();
    test.run_for(0.01);
    CHECK(test.looped() > looped);
  }
}
