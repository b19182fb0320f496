// Address decoding: peripheral blocks, bit-band aliases and the private peripheral bus.
#pragma once

#include <unicorn/unicorn.h>

#include <cstdint>
#include <string>
#include <vector>

#include "boards/stm32f405/core/machine.hpp"

namespace inkwell::virtual_board {

class SystemControl;

/// A block of 32-bit registers. A narrow read returns a part of the word. A narrow write replaces a part of the word
/// from stored().
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

class Bus {
 public:
  Bus(Machine& machine, SystemControl& system_control);

  /// While `*enable_register & enable_mask` is 0, the peripheral has no clock. Reads then return 0, and writes are
  /// ignored.
  void add(std::uint32_t base, std::uint32_t bytes, const std::string& name, Peripheral& peripheral,
           const std::uint32_t* enable_register = nullptr, std::uint32_t enable_mask = 0);
  void reset_peripherals();
  std::vector<RegisterMap> register_maps() const;

  struct Window {
    std::uint32_t base, bytes;
    uc_cb_mmio_read_t read;
    uc_cb_mmio_write_t write;
  };
  static const Window windows[6];
  /// True if an address window of the bus contains the address.
  static bool answers(std::uint32_t address) {
    for (const Window& window : windows)
      if (address - window.base < window.bytes) return true;
    return false;
  }

  std::uint32_t read(std::uint32_t address, unsigned size);
  void write(std::uint32_t address, std::uint32_t value, unsigned size);
  /// Register access by DMA, without processor wait cycles.
  std::uint32_t read_register(std::uint32_t address, unsigned size);
  void write_register(std::uint32_t address, std::uint32_t value, unsigned size);

 private:
  struct Slot {
    Peripheral* peripheral = nullptr;
    std::uint32_t base = 0;
    const std::uint32_t* enable_register = nullptr;
    std::uint32_t enable_mask = 0;
    std::string name;
    unsigned narrowest_write = 1;  ///< bytes
  };
  void check_width(std::uint32_t address, unsigned size);
  Slot* slot_at(std::uint32_t address);
  bool is_clocked(const Slot& slot, std::uint32_t address);
  void synchronise();
  void settle_processor();

  Machine& machine_;
  SystemControl& system_control_;
  std::vector<Slot> apb_and_ahb1_;  ///< one per kilobyte from 0x40000000
  std::vector<Slot> ahb2_;          ///< one per kilobyte from 0x50000000
  std::vector<Peripheral*> peripherals_;
  std::uint64_t access_began_ = 0;  ///< first cycle of the processor's access
};

}  // namespace inkwell::virtual_board
