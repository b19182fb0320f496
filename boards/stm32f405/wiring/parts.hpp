#pragma once

// To add a peripheral, first write a header like crc.hpp, with a RegisterBlock and a register map.
// Register and field names must match RM0090.
// Add a line to ChipParts::put_peripherals(), with base address, name and clock.
// In tests/boards/stm32f405, add a test firmware to firmware/ and a case to peripherals_test.cpp.
// Run `INKWELL_SVD=FILE tools/test` to compare the map with the manufacturer's chip description.

#include <deque>
#include <memory>
#include <string>
#include <vector>

#include "boards/stm32f405/core/machine.hpp"
#include "boards/stm32f405/core/processor.hpp"
#include "boards/stm32f405/core/system_control.hpp"
#include "boards/stm32f405/memory/bus.hpp"
#include "boards/stm32f405/memory/flash.hpp"
#include "boards/stm32f405/memory/memory.hpp"
#include "boards/stm32f405/memory/starting_clock.hpp"
#include "boards/stm32f405/peripherals/adc.hpp"
#include "boards/stm32f405/peripherals/dma.hpp"
#include "boards/stm32f405/peripherals/exti.hpp"
#include "boards/stm32f405/peripherals/pins.hpp"
#include "boards/stm32f405/peripherals/rcc.hpp"
#include "boards/stm32f405/peripherals/spi.hpp"
#include "boards/stm32f405/peripherals/timers.hpp"
#include "boards/stm32f405/peripherals/usart.hpp"
#include "boards/stm32f405/wiring/chip_debug_port.hpp"
#include "boards/stm32f405/wiring/execution.hpp"

namespace inkwell::virtual_board {

/// RCC register and bit that enable a peripheral's clock.
struct ClockGate {
  std::uint32_t enable_register, mask;
};

struct ChipParts : ChipState {
  ChipParts(Circuit& circuit, const ChipOptions& options);
  void add_outside_peripheral(std::uint32_t base, std::uint32_t size, const std::string& name, Peripheral& peripheral);

  std::uint32_t hclk_Hz() const override { return machine.clocks.frequencies.hclk_Hz; }
  std::uint32_t usb_Hz() const override { return machine.clocks.frequencies.usb_Hz; }
  bool has_function(char port, unsigned pin, unsigned alternate_function) const override {
    return machine.pins->has_function(static_cast<unsigned>(port - 'A'), pin, alternate_function);
  }

  Memory memory;
  StartingClock starting_clock;
  Machine machine;
  EventQueue events{machine.timeline};
  SystemControl system_control{machine};
  Bus bus{machine, system_control, starting_clock};
  Rcc rcc{machine, starting_clock};
  FlashController flash{machine};
  Exti exti{machine};
  Adcs adcs{machine};
  Dma dma{machine, bus};
  Timers timers{machine};
  Pins pins{machine};
  std::deque<Usart> usarts;  ///< by number - 1
  std::deque<Spi> spis;      ///< by number - 1
  Processor processor{machine, Bus::windows_of(bus), flash};
  Execution execution{machine, processor, bus, flash, system_control, rcc};
  ChipDebugPort debug_port{machine, processor, execution, bus, system_control};

 private:
  void put(std::uint32_t base, const std::string& name, Peripheral& peripheral);
  /// While `clock` is off, the peripheral does not respond. The RCC reset bit at the position of the enable bit resets
  /// the peripheral.
  void put(std::uint32_t base, const std::string& name, Peripheral& peripheral, ClockGate clock);
  /// Creates a peripheral that no other part of the chip uses.
  template <class Part, class... Arguments>
  Part& make(Arguments&&... arguments) {
    auto part = std::make_unique<Part>(std::forward<Arguments>(arguments)...);
    Part& made = *part;
    standalone_parts_.push_back(std::move(part));
    return made;
  }
  void put_peripherals();

  std::vector<std::unique_ptr<Peripheral>> standalone_parts_;
};

}  // namespace inkwell::virtual_board
