// Peripherals with 32-bit registers.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "boards/stm32f405/core/machine.hpp"

namespace inkwell::virtual_board {

/// A block of 32-bit registers. A narrow read returns a part of the word. A narrow write replaces a part of the stored
/// word.
class RegisterBlock : public Peripheral {
 public:
  std::uint32_t read(std::uint32_t offset, unsigned size) final {
    const std::uint32_t word = read_word(offset & ~3u);
    return size == 4 ? word : word >> 8 * (offset & 3) & (size == 1 ? 0xFFu : 0xFFFFu);
  }
  void write(std::uint32_t offset, std::uint32_t value, unsigned size) final {
    const std::uint32_t word = offset & ~3u;
    write_word(word, size == 4 ? value : merge(stored(word), value, offset, size));
  }
  std::vector<RegisterMap> register_maps(const std::string& name, std::uint32_t base) const override {
    return {{name, base, registers()}};
  }

 protected:
  virtual std::uint32_t read_word(std::uint32_t offset) = 0;
  virtual void write_word(std::uint32_t offset, std::uint32_t value) = 0;
  /// Returns the register value without the side effects of a read.
  virtual std::uint32_t stored(std::uint32_t) const { return 0; }
  virtual std::span<const MapEntry> registers() const { return {}; }
};

}  // namespace inkwell::virtual_board
