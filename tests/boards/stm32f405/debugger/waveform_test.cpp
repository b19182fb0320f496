#include <doctest/doctest.h>

#include <fstream>
#include <stdexcept>
#include "boards/stm32f405/debugger/waveform.hpp"

#include "tests/temporary_directory.hpp"

#include "tests/boards/stm32f405/chip_fixture.hpp"

using namespace inkwell::virtual_board;
using namespace inkwell::virtual_board::test;

namespace {

/// Runs the chip for `time_s` and returns the lines of the waveform file.
std::vector<std::string> lines_of(ChipUnderTest& test, double time_s, std::vector<PinName> pins) {
  const inkwell::tests::TemporaryDirectory directory;
  const auto path = directory / "waveform.vcd";
  {
    const Waveform waveform(path, std::move(pins), test.chip);
    test.run_for(time_s);
  }
  std::ifstream file(path);
  std::vector<std::string> lines;
  for (std::string line; std::getline(file, line);) lines.push_back(line);
  return lines;
}

}  // namespace

TEST_SUITE("virtual board: debugger") {
  TEST_CASE("a waveform has each edge of its pins at its time, and no other pin") {
    ChipUnderTest test("pwm");
    const auto lines = lines_of(test, 0.001, {PinName::of("PA8"), PinName::of("PA0")});
    const auto edges = test.circuit.edges_of('A', 8);
    REQUIRE(edges.size() > 20);
    std::vector<std::pair<std::uint64_t, char>> written;
    std::uint64_t now_ps = 0;
    bool running = false;
    for (const std::string& line : lines) {
      running |= line == "$end";
      if (line[0] == '#') {
        const std::uint64_t next_ps = std::stoull(line.substr(1));
        CHECK(next_ps >= now_ps);
        now_ps = next_ps;
      }
      if (running && line.size() == 4 && line.substr(1) == "PA8") written.emplace_back(now_ps, line[0]);
      CHECK(line.find("PC6") == std::string::npos);
    }
    REQUIRE(written.size() == edges.size());
    for (std::size_t i = 0; i < edges.size(); ++i) {
      CHECK(written[i].first == edges[i].when * 5000 / 42);
      CHECK(written[i].second == (edges[i].level == PinLevel::high  ? '1'
                                  : edges[i].level == PinLevel::low ? '0'
                                                                    : 'z'));
    }
    CHECK(now_ps == 1'000'000'000);
  }

  TEST_CASE("a waveform shows each exception that runs") {
    for (const Mode mode : {Mode::exact, Mode::fast}) {
      ChipUnderTest test("exceptions", mode);
      const auto lines = lines_of(test, 0.01, {});
      std::uint64_t entries = 0;
      for (std::size_t i = 1; i < lines.size(); ++i) entries += lines[i] == "b0001111 e";
      CHECK(entries == test.chip.counters().exceptions[15].count);
      CHECK(entries == 10);
    }
  }

  TEST_CASE("a waveform file that cannot be written raises an error") {
    ChipUnderTest test("pwm");
    CHECK_THROWS_AS(Waveform("/nowhere/at/all.vcd", {}, test.chip), std::runtime_error);
  }

  TEST_CASE("the level at a pin is the chip's, the circuit's, or that of the pull") {
    ChipUnderTest test("pwm");
    CHECK(test.chip.pin_level('A', 13) == PinLevel::high);  // pull-up after reset, for the debugger
    CHECK(test.chip.pin_level('A', 14) == PinLevel::low);   // pull-down
    CHECK(test.chip.pin_level('A', 0) == PinLevel::floating);
    test.chip.input_pins().drive('A', 0, PinLevel::high);
    CHECK(test.chip.pin_level('A', 0) == PinLevel::high);
    CHECK(test.chip.pin_output('A', 0) == PinLevel::floating);
    test.run_for(0.001);
    CHECK(test.chip.pin_output('A', 8) != PinLevel::floating);
    CHECK(test.chip.pin_level('A', 8) == test.chip.pin_output('A', 8));
  }
}
