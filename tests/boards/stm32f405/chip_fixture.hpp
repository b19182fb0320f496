// Fixture of the chip tests. A circuit records every edge of the test firmware's pins.
#pragma once

#include <doctest/doctest.h>

#include <map>
#include <string>
#include <utility>
#include <vector>
#include "boards/stm32f405/wiring/chip.hpp"

namespace inkwell::virtual_board::test {

struct Edge {
  char port;
  unsigned pin;
  PinLevel level;
  Ticks when;
};

class RecordingCircuit final : public Circuit {
 public:
  void output_changed(char port, unsigned pin, PinLevel level, Ticks now) override {
    check_time(now);
    edges.push_back({port, pin, level, now});
  }
  double analog_V(char port, unsigned pin, Ticks now) override {
    check_time(now);
    samples.push_back({port, pin, PinLevel::floating, now});
    const auto found = voltages.find({port, pin});
    return found == voltages.end() ? 0.0 : found->second;
  }
  AnalogSource analog_source(char port, unsigned pin) const override {
    const auto found = sources.find({port, pin});
    return found == sources.end() ? AnalogSource{} : found->second;
  }
  void advance(Ticks now) override {
    check_time(now);
    longest_pause = std::max(longest_pause, now - last_advance);
    last_advance = now;
  }
  std::vector<Edge> edges_of(char port, unsigned pin) const {
    std::vector<Edge> found;
    for (const auto& edge : edges)
      if (edge.port == port && edge.pin == pin) found.push_back(edge);
    return found;
  }

  std::vector<Edge> edges, samples;
  std::map<std::pair<char, unsigned>, double> voltages;
  std::map<std::pair<char, unsigned>, AnalogSource> sources;
  bool time_ran_backward = false;
  Ticks longest_pause = 0, last_advance = 0;

 private:
  void check_time(Ticks now) {
    time_ran_backward |= now < last_;
    last_ = now;
  }
  Ticks last_ = 0;
};

inline std::string firmware_path(const std::string& name) {
  return std::string(INKWELL_BUILD_DIRECTORY) + "/chip-firmware/" + name + ".elf";
}

/// The simulated chip runs a test firmware from reset. A violated hardware rule fails the test, unless the test expects
/// violations.
struct ChipUnderTest {
  explicit ChipUnderTest(const std::string& firmware, Mode mode = Mode::exact, Pricing pricing = Pricing::likely)
      : chip(circuit, options(mode, pricing)) {
    chip.load_elf(firmware_path(firmware));
    chip.reset();
  }
  ~ChipUnderTest() {
    if (breaks_rules) return;
    for (const Violation& violation : chip.violations()) FAIL_CHECK(sentence(violation));
  }
  bool has_broken(Rule rule) const {
    for (const Violation& violation : chip.violations())
      if (violation.rule == rule) return true;
    return false;
  }
  ChipOptions options(Mode mode, Pricing pricing) {
    ChipOptions chosen;
    chosen.mode = mode;
    chosen.pricing = pricing;
    chosen.log = [this](const std::string& line) { log.push_back(line); };
    return chosen;
  }
  std::uint32_t result(unsigned index) const { return chip.memory_word(0x2001F000 + 4 * index); }
  void run_for(double time_s) { chip.run_until(chip.now() + ticks(time_s)); }

  RecordingCircuit circuit;
  std::vector<std::string> log;
  Chip chip;
  bool breaks_rules = false;
};

inline constexpr std::uint32_t finished = 0x600D600D;

}  // namespace inkwell::virtual_board::test
