// Freezes SysTick while a debug probe halts the core (ARMv7-M, B3.3.1). Firmware selects the peripherals that also
// freeze (RM0090, "Debug MCU APB1 freeze register", "APB2 freeze register"). DBG_I2Cx_SMBUS_TIMEOUT has no effect,
// because the modeled I2C bus has no time-out.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace inkwell::virtual_board {

class Freezable {
 public:
  virtual ~Freezable() = default;
  virtual void freeze(bool frozen) = 0;
};

class DebugHalt {
 public:
  enum Bus : unsigned { apb1, apb2, core };

  void add(Freezable& part, Bus bus, unsigned bit) { lines_.push_back({&part, bus, bit}); }
  bool halted() const { return halted_; }
  void set_halted(bool halted) {
    halted_ = halted;
    update();
  }
  std::uint32_t stops(Bus bus) const { return stops_[bus]; }
  void set_stops(Bus bus, std::uint32_t value) {
    stops_[bus] = value;
    update();
  }

 private:
  struct Line {
    Freezable* part;
    Bus bus;
    unsigned bit;
    bool frozen = false;
  };
  void update() {
    for (Line& line : lines_) {
      const bool frozen = halted_ && (stops_[line.bus] >> line.bit & 1) != 0;
      if (frozen == line.frozen) continue;
      line.frozen = frozen;
      line.part->freeze(frozen);
    }
  }
  std::vector<Line> lines_;
  std::array<std::uint32_t, 3> stops_{0, 0, ~0u};
  bool halted_ = false;
};

}  // namespace inkwell::virtual_board
