// Random number generator (RM0090, RNG). The same seed leads to the same numbers.
#pragma once

#include "boards/stm32f405/memory/register_block.hpp"

namespace inkwell::virtual_board {

struct RandomNumberRegisters {
  struct : Register {
    Field rngen{"RNGEN", 2}, ie{"IE", 3};
  } cr{{"CR", 0x00}};
  struct : Register {
    Field drdy{"DRDY", 0, 1, Access::r};
  } sr{{"SR", 0x04}};
  struct : Register {
    Field rndata{"RNDATA", 0, 32, Access::r};
  } dr{{"DR", 0x08}};
};
inline constexpr RandomNumberRegisters rng;

class RandomNumbers final : public RegisterBlock {
 public:
  explicit RandomNumbers(std::uint32_t seed) : state_(seed != 0 ? seed : 1) {}
  void reset() override { control_ = 0; }

 protected:
  std::uint32_t read_word(std::uint32_t offset) override {
    const bool on = rng.cr.rngen.in(control_);
    if (offset == rng.cr) return control_;
    if (offset == rng.sr) return rng.sr.drdy.with(on);
    return offset == rng.dr && on ? next() : 0;
  }
  void write_word(std::uint32_t offset, std::uint32_t value) override {
    if (offset == rng.cr) control_ = value & writable(rng.cr);
  }
  std::span<const MapEntry> registers() const override { return shown<rng>(); }

 private:
  /// Marsaglia, "Xorshift RNGs".
  std::uint32_t next() {
    state_ ^= state_ << 13;
    state_ ^= state_ >> 17;
    state_ ^= state_ << 5;
    return state_;
  }
  std::uint32_t control_ = 0, state_;
};

}  // namespace inkwell::virtual_board
