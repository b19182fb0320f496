// Tests the access checks of the memory protection unit, and the effects of refused accesses.
#include <doctest/doctest.h>

#include "tests/boards/stm32f405/chip_fixture.hpp"

using namespace inkwell::virtual_board;
using namespace inkwell::virtual_board::test;

namespace {

constexpr std::uint32_t passes = 0, refused = 0x82, refused_instruction = 0x01, unaligned = 1u << 24,
                        no_answer = 0x8200, as_hard_fault = 1u << 30;

void check_results(const ChipUnderTest& test, unsigned first, const std::vector<std::uint32_t>& expected) {
  for (unsigned i = 0; i < expected.size(); ++i) {
    const unsigned number = first + i;
    CAPTURE(number);
    CHECK(test.result(number) == expected[i]);
  }
}

}  // namespace

TEST_SUITE("virtual chip: memory protection") {
  TEST_CASE("regions, their order, eighths and edges, rights, the default map, masks and kinds of memory") {
    for (const Mode mode : {Mode::exact, Mode::fast}) {
      CAPTURE(static_cast<int>(mode));
      ChipUnderTest test("protection", mode);
      const Stop stop = test.chip.run_until(ticks(0.01));
      REQUIRE(test.result(0) == finished);
      // The test uses three areas: a read-only page, a region with a disabled third subregion above this page, and 32
      // bytes in another page.
      check_results(test, 1,
                    {passes, refused, passes, refused, passes, refused, refused, refused, refused, passes, passes});
      // Executes an instruction that crosses into a non-executable region, and an instruction inside this region.
      check_results(test, 12,
                    {passes, passes, refused_instruction, 0x3E, refused_instruction, 0x40, passes, refused_instruction,
                     0x40, refused_instruction});
      // AP: privileged load and store, unprivileged load and store (PM0214, "AP encoding").
      check_results(test, 22, {0b0000, 0b0011, 0b0111, 0b1111, 0b0000, 0b0001, 0b0101, 0b0101});
      check_results(test, 30, {passes, refused, refused, passes, no_answer, 0x800});
      check_results(test, 36, {refused, passes, refused, refused | as_hard_fault, 1, refused | as_hard_fault});
      check_results(test, 42, {passes, unaligned, passes});
      // nPRIV of CONTROL is readable in thread mode and in handlers. SPSEL is readable only in thread mode.
      check_results(test, 45, {passes, 1, static_cast<std::uint32_t>(-32), 3, 0});
      CHECK(stop == Stop::locked_up);
      CHECK(test.chip.lockup_reason().find("the memory protection unit refuses 0x20010000") != std::string::npos);
    }
  }

  TEST_CASE("the firmware's protection lets its own accesses pass, and nothing that only an error does") {
    for (const Mode mode : {Mode::exact, Mode::fast}) {
      CAPTURE(static_cast<int>(mode));
      ChipUnderTest test("guarded_memory", mode);
      test.run_for(0.001);
      REQUIRE(test.result(0) == finished);
      check_results(test, 1, {passes, passes, passes, passes, passes, passes, passes, passes, passes});
      check_results(test, 10,
                    {refused, refused, refused_instruction, refused, refused, refused, refused, refused, refused,
                     refused_instruction, refused_instruction, refused_instruction, refused, refused});
    }
  }

  TEST_CASE("a protection region with attributes that the manual leaves undefined breaks a rule") {
    for (unsigned number = 0; number < 8; ++number) {
      CAPTURE(number);
      ChipUnderTest test("reserved_regions");
      test.breaks_rules = number != 0;
      for (unsigned pin = 0; pin < 3; ++pin)
        test.chip.input_pins().drive('D', pin, (number >> pin & 1) != 0 ? PinLevel::high : PinLevel::low);
      test.run_for(0.001);
      REQUIRE(test.result(0) == finished);
      CHECK(test.has_broken(Rule::region_undefined) == (number != 0));
    }
  }

  TEST_CASE("a frame that is refused in part is a fault at entry, at return, or at the first float") {
    constexpr std::uint32_t stacking = 0x10, unstacking = 0x08, lazy = 0x20, active = 1u << 31, called = 0x5C,
                            two = 0x4000'0000;
    for (const Mode mode : {Mode::exact, Mode::fast}) {
      CAPTURE(static_cast<int>(mode));
      ChipUnderTest test("protected_stacks", mode);
      test.run_for(0.01);
      REQUIRE(test.result(0) == finished);
      check_results(test, 1, {stacking, called, called, unstacking});
      check_results(test, 5, {1, lazy | active, 0, two, two});
      check_results(test, 10, {1, 0, lazy, 7, 8, called, two});
    }
  }

  TEST_CASE(
      "lazy floating-point stacking records the interrupted context and the faults that were possible at that time") {
    constexpr std::uint32_t due = 0xC000'0001, user = 0x002, thread = 0x008, hard = 0x010, memory = 0x020, bus = 0x040,
                            monitor = 0x100, behind_frame = 0x20;
    for (const Mode mode : {Mode::exact, Mode::fast}) {
      CAPTURE(static_cast<int>(mode));
      ChipUnderTest test("lazy_stacking", mode);
      test.run_for(0.001);
      REQUIRE(test.result(0) == finished);
      check_results(test, 1, {due | thread | hard, behind_frame});
      check_results(test, 3, {due | thread | hard | memory | bus | monitor, behind_frame});
      check_results(test, 5, {due | thread | hard | memory, behind_frame});
      check_results(test, 7, {due | hard | memory | bus | monitor, behind_frame});
      check_results(test, 9, {due | user | thread | hard | memory | bus | monitor, behind_frame});
      check_results(test, 11, {0x8000'0000 | thread});
    }
  }
}
