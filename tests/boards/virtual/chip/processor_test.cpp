#include <doctest/doctest.h>

#include "chip_fixture.hpp"

using namespace inkwell::virtual_board;
using namespace inkwell::virtual_board::test;

TEST_SUITE("virtual chip: processor") {
  TEST_CASE("exceptions: priorities, chaining, masks, stacks and floating-point context") {
    for (const Mode mode : {Mode::exact, Mode::fast}) {
      CAPTURE(static_cast<int>(mode));
      Rig rig("exceptions", mode);
      rig.run_for(0.01);
      REQUIRE(rig.result(0) == finished);
      CHECK(rig.result(1) == 0x1324);               // 7 preempts 6 in its middle, 8 waits and follows
      CHECK(rig.result(2) == 0x394893);             // BASEPRI: 3, then 4 on release; PRIMASK: 3 on release
      CHECK(rig.result(3) == 42);                   // SVC found its argument on the process stack
      CHECK((rig.result(4) | 0x10) == 0xFFFFFFFD);  // PendSV returns to thread mode on the process stack
      CHECK(rig.result(5) == 0x40100000);           // S15 is still 2.25
      CHECK(rig.result(6) == 0);                    // FPSCR's rounding mode too
      CHECK(rig.result(7) == 5);
      CHECK(rig.result(8) == 10);
      const auto& counters = rig.chip.counters();
      CHECK(counters.exceptions[11].count == 1);
      CHECK(counters.exceptions[15].count == 10);
      CHECK(counters.exceptions[16 + 7].count == 3);
      CHECK(rig.log.empty());
    }
  }

  TEST_CASE("SysTick comes every 1000 cycles of 16 MHz") {
    Rig rig("exceptions");
    const auto& counters = rig.chip.counters();
    std::vector<Ticks> times;
    std::uint64_t seen = 0;
    for (Ticks t = 0; t < ticks(0.002); t += ticks(1e-6)) {
      rig.chip.run_until(t);
      if (rig.chip.counters().exceptions[15].count != seen) {
        seen = counters.exceptions[15].count;
        times.push_back(t);
      }
    }
    REQUIRE(times.size() == 10);
    const double period_s = seconds(times.back() - times.front()) / 9;
    CHECK(period_s == doctest::Approx(1000.0 / 16e6).epsilon(0.005));
  }

  TEST_CASE("faults leave their record, and a fault inside HardFault locks up") {
    Rig rig("faults");
    CHECK(rig.chip.run_until(ticks(0.01)) == Stop::locked_up);
    REQUIRE(rig.result(0) == finished);
    // A precise bus fault with its address, escalated: BusFault is off.
    CHECK(rig.result(4) == 0x8200);
    CHECK(rig.result(5) == 1u << 30);
    CHECK(rig.result(6) == 0x60000000);
    CHECK(rig.result(7) == 0);
    CHECK(rig.result(8) == 0x8200);
    CHECK(rig.result(9) == 0);
    CHECK(rig.result(10) == 0x2F000000);
    CHECK(rig.result(11) == 0);
    CHECK(rig.result(12) == 1u << 16);  // UNDEFINSTR
    CHECK(rig.result(15) == 0);
    CHECK(rig.chip.lockup_reason().find("0x60000000") != std::string::npos);
    // Only a reset helps.
    rig.chip.reset();
    CHECK(rig.chip.run_until(rig.chip.now() + ticks(10e-6)) == Stop::time_reached);
  }

  TEST_CASE("an if-then block that is stopped or interrupted in its middle goes on as it began") {
    for (const Mode mode : {Mode::exact, Mode::fast}) {
      CAPTURE(static_cast<int>(mode));
      Rig rig("conditional", mode);
      // In steps of 22 cycles, so that most stops come without an interrupt.
      for (int step = 0; step < 60'000 && rig.result(0) != finished; ++step) rig.run_for(1.375e-6);
      REQUIRE(rig.result(0) == finished);
      CHECK(rig.result(1) == 10'000u * (1 + 256 + 4096));
      CHECK(rig.result(2) == 10'000u * (1 + 256 + 2 + 512));
      CHECK(rig.result(3) > 1000);
      CHECK(rig.result(4) == 10'000u * (3 + 256));
      CHECK(rig.log.empty());
    }
  }

  TEST_CASE("code in RAM that is written anew runs anew") {
    for (const Mode mode : {Mode::exact, Mode::fast}) {
      CAPTURE(static_cast<int>(mode));
      Rig rig("code_in_ram", mode);
      rig.run_for(0.01);
      REQUIRE(rig.result(0) == finished);
      CHECK(rig.result(1) == 0);
      CHECK(rig.result(2) == 7 + 1 + 16);
      CHECK(rig.result(3) == 7 + 1 + 32);
      CHECK(rig.log.empty());
    }
  }

  TEST_CASE("exact mode: the same state after each run, to the instruction") {
    std::uint64_t hashes[2];
    for (auto& hash : hashes) {
      Rig rig("servo");
      rig.run_for(0.02);
      CHECK(rig.chip.counters().exceptions[16 + 18].count > 350);
      hash = rig.chip.state_hash();
    }
    CHECK(hashes[0] == hashes[1]);
    Rig other("servo");
    other.run_for(0.0201);
    CHECK(other.chip.state_hash() != hashes[0]);
  }

  TEST_CASE("the watchdog resets the chip once, and says so") {
    Rig rig("watchdog");
    std::vector<std::pair<ResetCause, Ticks>> resets;
    rig.chip.on_reset = [&](ResetCause cause) { resets.emplace_back(cause, rig.chip.now()); };
    rig.run_for(0.2);
    CHECK(rig.result(0) == finished);
    CHECK(rig.result(1) == (1u << 29 | 1u << 26));  // IWDGRSTF and PINRSTF
    REQUIRE(resets.size() == 1);
    CHECK(resets[0].first == ResetCause::independent_watchdog);
    // 500 counts of 4 cycles of 32 kHz, after a few instructions.
    CHECK(seconds(resets[0].second) == doctest::Approx(0.0625).epsilon(0.01));
    CHECK(rig.chip.counters().resets[static_cast<std::size_t>(ResetCause::independent_watchdog)] == 1);
  }
}
