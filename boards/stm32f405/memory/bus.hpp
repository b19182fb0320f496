// Address decoding: peripheral blocks, bit-band aliases and the private peripheral bus.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "boards/stm32f405/core/bus_windows.hpp"
#include "boards/stm32f405/core/machine.hpp"
#include "boards/stm32f405/memory/starting_clock.hpp"

namespace inkwell::virtual_board {

class Processor;
class SystemControl;

class Bus {
 public:
  Bus(Machine& machine, Processor& processor, SystemControl& system_control, const StartingClock& starting_clock);

  /// While `*enable_register & enable_mask` is 0, the peripheral has no clock. Without a clock, reads return 0 and
  /// writes are ignored.
  void add(std::uint32_t base, std::uint32_t bytes, const std::string& name, Peripheral& peripheral,
           const std::uint32_t* enable_register = nullptr, std::uint32_t enable_mask = 0);
  void reset_peripherals();
  std::vector<RegisterMap> register_maps() const;

  /// `bus` may be constructed after this call.
  static BusWindows windows_of(Bus& bus) { return {all_windows, &bus}; }

  std::uint32_t read(std::uint32_t address, unsigned size);
  void write(std::uint32_t address, std::uint32_t value, unsigned size);
  /// Register access by DMA, without processor wait cycles.
  std::uint32_t read_register(std::uint32_t address, unsigned size);
  void write_register(std::uint32_t address, std::uint32_t value, unsigned size);

 private:
  static const BusWindow all_windows[6];
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
  Processor& processor_;
  SystemControl& system_control_;
  const StartingClock& starting_clock_;
  std::vector<Slot> apb_and_ahb1_;  ///< one per kilobyte from 0x40000000
  std::vector<Slot> ahb2_;          ///< one per kilobyte from 0x50000000
  std::vector<Peripheral*> peripherals_;
  std::uint64_t access_began_ = 0;  ///< first cycle of the processor's access
};

}  // namespace inkwell::virtual_board
