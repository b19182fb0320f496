#include <doctest/doctest.h>

#include "tests/boards/stm32f405/chip_fixture.hpp"

using namespace inkwell::virtual_board;
using namespace inkwell::virtual_board::test;

TEST_SUITE("virtual chip: processor") {
  TEST_CASE("exceptions: priorities, chaining, masks, stacks and floating-point context") {
    for (const Mode mode : {Mode::exact, Mode::fast}) {
      CAPTURE(static_cast<int>(mode));
      ChipUnderTest test("exceptions", mode);
      test.run_for(0.01);
      REQUIRE(test.result(0) == finished);
      CHECK(test.result(1) == 0x1324);               // 7 preempts 6; 8 waits and follows
      CHECK(test.result(2) == 0x394893);             // BASEPRI: 3, then 4 after its release; PRIMASK: 3 after its
                                                     // release
      CHECK(test.result(3) == 42);                   // SVC read its argument from the process stack
      CHECK((test.result(4) | 0x10) == 0xFFFFFFFD);  // PendSV returns to thread mode on the process stack
      CHECK(test.result(5) == 0x40100000);           // S15 is still 2.25
      CHECK(test.result(6) == 0);                    // FPSCR's rounding mode is also restored
      CHECK(test.result(7) == 5);
      CHECK(test.result(8) == 10);
      const auto& counters = test.chip.counters();
      CHECK(counters.exceptions[11].count == 1);
      CHECK(counters.exceptions[15].count == 10);
      CHECK(counters.exceptions[16 + 7].count == 3);
      CHECK(test.log.empty());
    }
  }

  TEST_CASE("SysTick occurs every 1000 cycles of 16 MHz") {
    ChipUnderTest test("exceptions");
    const auto& counters = test.chip.counters();
    std::vector<Ticks> times;
    std::uint64_t seen = 0;
    for (Ticks t = 0; t < ticks(0.002); t += ticks(1e-6)) {
      test.chip.run_until(t);
      if (test.chip.counters().exceptions[15].count != seen) {
        seen = counters.exceptions[15].count;
        times.push_back(t);
      }
    }
    REQUIRE(times.size() == 10);
    const double period_s = seconds(times.back() - times.front()) / 9;
    CHECK(period_s == doctest::Approx(1000.0 / 16e6).scale(0).epsilon(0.005));
  }

  TEST_CASE("faults leave their record, and a fault inside HardFault locks up") {
    ChipUnderTest test("cpu_faults");
    CHECK(test.chip.run_until(ticks(0.01)) == Stop::locked_up);
    REQUIRE(test.result(0) == finished);
    // The bus fault escalates because BusFault is disabled.
    CHECK(test.result(4) == 0x8200);
    CHECK(test.result(5) == 1u << 30);
    CHECK(test.result(6) == 0x60000000);
    CHECK(test.result(7) == 0);
    CHECK(test.result(8) == 0x8200);
    CHECK(test.result(9) == 0);
    CHECK(test.result(10) == 0x2F000000);
    CHECK(test.result(11) == 0);
    CHECK(test.result(12) == 1u << 16);  // UNDEFINSTR
    CHECK(test.result(15) == 0);
    CHECK(test.chip.lockup_reason().find("0x60000000") != std::string::npos);
    // Only a reset resolves a lock-up.
    test.chip.reset();
    CHECK(test.chip.run_until(test.chip.now() + ticks(10e-6)) == Stop::time_reached);
  }

  TEST_CASE("a division by zero returns 0, or raises a fault if the firmware enables this") {
    for (const Mode mode : {Mode::exact, Mode::fast}) {
      CAPTURE(static_cast<int>(mode));
      ChipUnderTest test("division", mode);
      test.run_for(0.001);
      REQUIRE(test.result(0) == finished);
      CHECK(test.result(1) == 0);
      CHECK(test.result(2) == 0);
      CHECK(test.result(3) == 3);
      CHECK(test.result(4) == 0);
      CHECK(test.result(5) == 77);  // nothing was written
      CHECK(test.result(6) == 1);
      CHECK(test.result(7) == 1u << 25);  // DIVBYZERO
      CHECK(test.result(8) == 0xFBB0);    // the stacked program counter is the divide's
      CHECK(test.result(9) == 0);
      CHECK(test.result(10) == 1);
      CHECK(test.log.empty());
    }
  }

  TEST_CASE("the memory protection unit keeps eight regions") {
    ChipUnderTest test("memory_protection");
    test.run_for(0.001);
    REQUIRE(test.result(0) == finished);
    CHECK(test.result(1) == 0x800);
    CHECK(test.result(2) == 5);
    CHECK(test.result(3) == 0x0800'0005);
    CHECK(test.result(4) == 0x2000'0003);
    CHECK(test.result(5) == 0x0306'0021);
    CHECK(test.result(6) == 0);
    CHECK(test.result(7) == 5);
    CHECK(test.log.empty());
  }

  TEST_CASE("accesses fault by alignment and protection, and the fault names the instruction") {
    constexpr std::uint32_t unaligned = 1u << 24, no_answer = 0x8200, refused_data = 0x82, refused_code = 0x01;
    for (const Mode mode : {Mode::exact, Mode::fast}) {
      CAPTURE(static_cast<int>(mode));
      ChipUnderTest test("accesses", mode);
      test.run_for(0.001);
      REQUIRE(test.result(0) == finished);
      const auto record = [&](unsigned number, unsigned part) { return test.result(4 + 4 * number + part); };
      for (unsigned number = 0; number < 9; ++number) {
        CAPTURE(number);
        CHECK(record(number, 0) == unaligned);
        CHECK(record(number, 2) == 0);
      }
      CHECK(test.result(1) == 0x5544'3322);
      CHECK(test.result(2) == 0x3322);
      CHECK(test.result(3) == 0x5544'3322);
      CHECK(record(9, 0) == no_answer);
      CHECK(record(9, 1) == 0x6000'0000);
      CHECK(record(9, 2) == 0);
      CHECK(record(10, 0) == refused_data);
      CHECK(record(10, 1) % 64 == 32);
      CHECK(record(10, 2) == 0);
      CHECK(test.result(100) == 7);
      CHECK(record(11, 0) == refused_code);
      CHECK(test.result(101) == 8);
      // The third of four instructions in an IT block faults, and the rest of the block is executed normally.
      CHECK(record(12, 0) == no_answer);
      CHECK(record(12, 2) == 0);
      CHECK(record(12, 3) != 0);
      CHECK(test.result(102) == 1);
      for (unsigned number = 13; number < 18; ++number) {
        CAPTURE(number);
        CHECK(record(number, 0) == unaligned);
        CHECK(record(number, 2) == 0);
      }
      CHECK(test.result(103) == 0x1234'0012);
      CHECK(test.log.empty());
    }
  }

  TEST_CASE("a stack that cannot hold a frame is a fault, whose handler runs without one") {
    for (const Mode mode : {Mode::exact, Mode::fast}) {
      CAPTURE(static_cast<int>(mode));
      ChipUnderTest test("stacks", mode);
      test.run_for(0.001);
      REQUIRE(test.result(0) == finished);
      CHECK(test.result(1) == 1u << 12);          // STKERR, on BusFault
      CHECK(test.result(2) == 0x2002'0000 + 96);  // address of the frame
      CHECK(test.result(3) == 0);
      CHECK(test.result(4) == 1u << 4);  // MSTKERR, in HardFault because MemManage is disabled
      CHECK(test.result(5) == 1u << 30);
      CHECK(test.result(6) == 7);  // SVC followed the fault of its stacking
    }
  }

  TEST_CASE("a fault whose handler is missing locks up, and the missing handler is named") {
    ChipUnderTest test("no_handler");
    REQUIRE(test.chip.run_until(ticks(0.001)) == Stop::locked_up);
    CHECK(test.result(0) == finished);
    CHECK(test.chip.lockup_reason().find("no handler for HardFault") != std::string::npos);
    REQUIRE(test.chip.first_fault());
    CHECK(test.chip.first_fault()->what.find("0x60000000") != std::string::npos);
  }

  TEST_CASE("an if-then block that is stopped or interrupted continues correctly") {
    for (const Mode mode : {Mode::exact, Mode::fast}) {
      CAPTURE(static_cast<int>(mode));
      ChipUnderTest test("conditional", mode);
      for (int step = 0; step < 60'000 && test.result(0) != finished; ++step) test.run_for(1.375e-6);
      REQUIRE(test.result(0) == finished);
      CHECK(test.result(1) == 10'000u * (1 + 256 + 4096));
      CHECK(test.result(2) == 10'000u * (1 + 256 + 2 + 512));
      CHECK(test.result(3) > 1000);
      CHECK(test.result(4) == 10'000u * (3 + 256));
      CHECK(test.log.empty());
    }
  }

  TEST_CASE("an if-then block across a page boundary continues correctly") {
    for (const Mode mode : {Mode::exact, Mode::fast}) {
      CAPTURE(static_cast<int>(mode));
      ChipUnderTest test("conditional_across_pages", mode);
      test.run_for(0.1);
      REQUIRE(test.result(0) == finished);
      CHECK(test.result(1) == 10'000u * (3 + 256));
      CHECK(test.result(2) > 1000);
      // A few interrupts occur before or after the counting.
      const auto entries = test.chip.counters().exceptions[15].count;
      CHECK(entries - test.result(2) <= 4);
      CHECK(test.log.empty());
    }
  }

  TEST_CASE("the core executes the new code after code in RAM is rewritten") {
    for (const Mode mode : {Mode::exact, Mode::fast}) {
      CAPTURE(static_cast<int>(mode));
      ChipUnderTest test("code_in_ram", mode);
      test.run_for(0.01);
      REQUIRE(test.result(0) == finished);
      CHECK(test.result(1) == 0);
      CHECK(test.result(2) == 7 + 1 + 16);
      CHECK(test.result(3) == 7 + 1 + 32);
      // The two functions differ in one instruction: a push of twelve registers replaces an addition. In fast mode the
      // cycle counter advances by whole blocks.
      if (mode == Mode::exact) CHECK(test.result(5) == test.result(4) + 12);
      CHECK(test.result(5) > test.result(4));
      CHECK(test.log.empty());
    }
  }

  TEST_CASE("SRAM1 at address 0 runs code, follows changes at both addresses, and gives way to the flash at a reset") {
    for (const Mode mode : {Mode::exact, Mode::fast}) {
      CAPTURE(static_cast<int>(mode));
      ChipUnderTest test("remapped_sram", mode);
      test.run_for(0.02);
      REQUIRE(test.result(0) == finished);
      CHECK(test.result(1) == 1);
      CHECK(test.result(2) == 1);
      CHECK(test.result(3) == 0);
      if (mode == Mode::exact) CHECK(test.result(4) == test.result(5) + 1);  // the return from SRAM1
      CHECK(test.result(8) == 1);
      CHECK(test.result(9) == 1);
      CHECK(test.log.empty());
    }
  }

  TEST_CASE("exact mode: the same state after each run, to the instruction") {
    std::uint64_t hashes[2];
    for (auto& hash : hashes) {
      ChipUnderTest test("servo");
      test.run_for(0.02);
      CHECK(test.chip.counters().exceptions[16 + 18].count > 350);
      hash = test.chip.state_hash();
    }
    CHECK(hashes[0] == hashes[1]);
    ChipUnderTest other("servo");
    other.run_for(0.0201);
    CHECK(other.chip.state_hash() != hashes[0]);
  }

  TEST_CASE("the watchdog resets the chip once and sets its reset flag") {
    ChipUnderTest test("watchdog");
    std::vector<std::pair<ResetCause, Ticks>> resets;
    test.chip.on_reset = [&](ResetCause cause) { resets.emplace_back(cause, test.chip.now()); };
    test.run_for(0.2);
    CHECK(test.result(0) == finished);
    CHECK(test.result(1) == (1u << 29 | 1u << 26));  // IWDGRSTF and PINRSTF
    REQUIRE(resets.size() == 1);
    CHECK(resets[0].first == ResetCause::independent_watchdog);
    // The watchdog expires after 62.5 ms: 500 counts of 4 cycles at 32 kHz.
    CHECK(seconds(resets[0].second) == doctest::Approx(0.0625).scale(0).epsilon(0.01));
    CHECK(test.chip.counters().resets[static_cast<std::size_t>(ResetCause::independent_watchdog)] == 1);
  }
}
