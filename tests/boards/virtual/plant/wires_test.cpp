#include "boards/virtual/plant/wires.hpp"

#include <cmath>
#include <map>
#include <utility>

#include <doctest/doctest.h>

using namespace inkwell::virtual_board;

namespace {

class TwoEnds final : public Circuit, public InputPins {
 public:
  void output_changed(char port, unsigned pin, PinLevel level, Ticks) override { heard[{port, pin}] = level; }
  double analog_V(char port, unsigned pin, Ticks) override { return volts[{port, pin}]; }
  AnalogSource analog_source(char, unsigned) const override { return {10e3, 100e-9, pull_down_ohm}; }
  void advance(Ticks) override {}
  void drive(char port, unsigned pin, PinLevel level, Ticks since) override {
    seen[{port, pin}] = level;
    newest = since;
  }
  void hold(char port, unsigned pin, PinLevel level) override { held[{port, pin}] = level; }
  std::map<std::pair<char, unsigned>, PinLevel> heard, seen, held;
  std::map<std::pair<char, unsigned>, double> volts;
  double pull_down_ohm = 0.0;
  Ticks newest = 0;
};

struct Wired {
  Wired() { wires.connect(ends); }
  TwoEnds ends;
  Wires wires{ends};
};

constexpr PinName a0{'A', 0}, a1{'A', 1}, c3{'C', 3};

}  // namespace

TEST_CASE("healthy wires transfer levels, times and voltages") {
  Wired w;
  w.wires.drive('A', 0, PinLevel::high, 77);
  CHECK(w.ends.seen[{'A', 0}] == PinLevel::high);
  CHECK(w.ends.newest == 77);
  w.wires.output_changed('B', 1, PinLevel::high, 100);
  CHECK(w.ends.heard[{'B', 1}] == PinLevel::high);
  w.ends.volts[{'C', 3}] = 1.25;
  CHECK(w.wires.analog_V('C', 3, 200) == 1.25);
}

TEST_CASE("a digital wire that is broken, shorted or frozen, in both directions, and healed") {
  for (const auto& [fault, level] : {std::pair{WireFault::open, PinLevel::floating},
                                     {WireFault::low, PinLevel::low},
                                     {WireFault::high, PinLevel::high},
                                     {WireFault::frozen, PinLevel::low}}) {
    CAPTURE(static_cast<int>(fault));
    Wired w;
    w.wires.drive('A', 0, PinLevel::low, 1);
    w.wires.output_changed('A', 0, PinLevel::low, 1);
    w.wires.set(a0, fault);
    CHECK(w.ends.seen[{'A', 0}] == level);
    CHECK(w.ends.heard[{'A', 0}] == level);
    w.wires.drive('A', 0, PinLevel::high, 2);
    w.wires.output_changed('A', 0, PinLevel::high, 2);
    CHECK(w.ends.seen[{'A', 0}] == level);
    CHECK(w.ends.heard[{'A', 0}] == level);
    w.wires.set(a0, WireFault::intact);
    CHECK(w.ends.seen[{'A', 0}] == PinLevel::high);
    CHECK(w.ends.heard[{'A', 0}] == PinLevel::high);
  }
}

TEST_CASE("a wire that touches ground or 3.3 V holds the chip's pin there, any other leaves it to the chip") {
  for (const auto& [fault, level] : {std::pair{WireFault::low, PinLevel::low},
                                     {WireFault::high, PinLevel::high},
                                     {WireFault::open, PinLevel::floating},
                                     {WireFault::frozen, PinLevel::floating}}) {
    CAPTURE(static_cast<int>(fault));
    Wired w;
    w.wires.output_changed('A', 0, PinLevel::low, 1);
    w.wires.set(a0, fault);
    CHECK(w.ends.held[{'A', 0}] == level);
    w.wires.set(a0, WireFault::intact);
    CHECK(w.ends.held[{'A', 0}] == PinLevel::floating);
  }
}

TEST_CASE("an analogue wire that is broken, shorted or frozen") {
  Wired w;
  w.ends.volts[{'C', 3}] = 2.0;
  CHECK(w.wires.analog_V('C', 3, 0) == 2.0);
  w.ends.volts[{'C', 3}] = 1.0;
  w.wires.set(c3, WireFault::frozen);
  CHECK(w.wires.analog_V('C', 3, ticks(0.5)) == 2.0);
  CHECK(w.wires.analog_source('C', 3).resistance_ohm == 0.0);
  CHECK(w.wires.analog_source('C', 4).resistance_ohm == 10e3);
  CHECK(w.wires.analog_source('C', 4).capacitance_F == 100e-9);
  w.wires.set(c3, WireFault::low);
  CHECK(w.wires.analog_V('C', 3, ticks(0.5)) == 0.0);
  w.wires.set(c3, WireFault::high);
  CHECK(w.wires.analog_V('C', 3, ticks(0.5)) == 3.3);
  w.wires.set(c3, WireFault::intact);
  CHECK(w.wires.analog_V('C', 3, ticks(0.5)) == 1.0);
  w.wires.set(c3, WireFault::open);  // the converter's capacitor discharges slowly
  CHECK(w.wires.analog_V('C', 3, ticks(0.5)) == doctest::Approx(1.0));
  CHECK(w.wires.analog_V('C', 3, ticks(0.51)) == doctest::Approx(std::exp(-1.0)));
  w.ends.pull_down_ohm = 20e3;  // a resistor discharges the capacitor faster
  CHECK(w.wires.analog_V('C', 3, ticks(0.502)) == doctest::Approx(std::exp(-1.0)));
  CHECK(w.wires.analog_V('C', 3, ticks(0.504)) == doctest::Approx(std::exp(-2.0)));
}

TEST_CASE("two shorted wires have the low level, or the mean of their voltages") {
  Wired w;
  w.wires.drive('A', 0, PinLevel::high, 1);
  w.wires.drive('A', 1, PinLevel::low, 1);
  w.wires.set_contact(a0, a1, true);
  CHECK(w.ends.seen[{'A', 0}] == PinLevel::low);
  w.wires.drive('A', 1, PinLevel::high, 5);
  CHECK(w.ends.seen[{'A', 0}] == PinLevel::high);
  CHECK(w.ends.seen[{'A', 1}] == PinLevel::high);
  w.wires.drive('A', 0, PinLevel::low, 6);
  CHECK(w.ends.seen[{'A', 1}] == PinLevel::low);
  CHECK(w.ends.newest == 6);
  w.wires.output_changed('A', 0, PinLevel::high, 7);  // the other wire is not driven from this pin
  CHECK(w.ends.heard[{'A', 1}] == PinLevel::high);
  w.ends.volts = {{{'A', 0}, 1.0}, {{'A', 1}, 2.0}};
  CHECK(w.wires.analog_V('A', 0, 8) == 1.5);
  w.wires.set_contact(a1, a0, false);
  CHECK(w.ends.seen[{'A', 1}] == PinLevel::high);
  CHECK(w.wires.analog_V('A', 0, 9) == 1.0);
}
