#pragma once

// To add a peripheral:
// 1. Write a header like crc.hpp. It contains a map with the register and field names of RM0090, and a
//    RegisterBlock.
// 2. Add a line with base address, name and clock to ChipParts::put_peripherals().
// 3. Add a firmware that uses the peripheral to tests/boards/virtual/chip/firmware and a case to
//    peripherals_test.cpp.
// 4. Compare the map with the manufacturer's description of the chip: INKWELL_SVD=FILE tools/test

#include <deque>
#include <memory>
#include <string>
#include <vector>

#include "adc.hpp"
#include "bus.hpp"
#include "debug_port.hpp"
#include "dma.hpp"
#include "execution.hpp"
#include "exti.hpp"
#include "flash.hpp"
#include "machine.hpp"
#include "pins.hpp"
#include "processor.hpp"
#include "rcc.hpp"
#include "spi.hpp"
#include "system_control.hpp"
#include "timers.hpp"
#include "usart.hpp"

namespace inkwell::virtual_board {

/// Register and bit of RCC that enable the clock of a peripheral.
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

  Machine machine;
  EventQueue events{machine.timeline};
  SystemControl system_control{machine};
  Bus bus{machine, system_control};
  Rcc rcc{machine};
  FlashController flash{machine};
  Exti exti{machine};
  Adcs adcs{machine};
  Dma dma{machine, bus};
  Timers timers{machine};
  Pins pins{machine};
  std::deque<Usart> usarts;  ///< by number - 1
  std::deque<Spi> spis;      ///< by number - 1
  Processor processor{machine, bus};
  Execution execution{machine, processor, bus, system_control, rcc};
  ChipDebugPort debug_port{machine, processor, execution, bus, system_control};

 private:
  void put(std::uint32_t base, const std::string& name, Peripheral& peripheral);
  /// Without its clock the peripheral does not respond. A reset bit at the same position resets the peripheral.
  void put(std::uint32_t base, const std::string& name, Peripheral& peripheral, ClockGate clock);
  /// Creates a peripheral to which no other part refers.
  template <class Part, class... Arguments>
  Part& make(Arguments&&... arguments) {
    auto part = std::make_unique<Part>(std::forward<Arguments>(arguments)...);
    Part& made = *part;
    on_their_own_.push_back(std::move(part));
    return made;
  }
  void put_peripherals();

  std::vector<std::unique_ptr<Peripheral>> on_their_own_;
};

}  // namespace inkwell::virtual_board
