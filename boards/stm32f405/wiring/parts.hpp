#pragma once

// To add a peripheral, first write a header like crc.hpp, with a RegisterBlock and a register map.
// Register and field names must match RM0090.
// The constructor receives the parts that the peripheral uses. lines.hpp declares the lines between peripherals.
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
#include "boards/stm32f405/peripherals/power.hpp"
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

struct ChipParts : ChipState,
                   private CodePosition,
                   private FlashPort,
                   private CrystalFailure,
                   private DmaUsers,
                   private TimerEventUsers,
                   private PinFunctions,
                   private TimerOutputs {
  ChipParts(Circuit& circuit, const ChipOptions& options);
  void add_outside_peripheral(std::uint32_t base, std::uint32_t size, const std::string& name, Peripheral& peripheral);

  std::uint32_t hclk_Hz() const override { return machine.clocks.frequencies.hclk_Hz; }
  std::uint32_t usb_Hz() const override { return machine.clocks.frequencies.usb_Hz; }
  bool has_function(char port, unsigned pin, unsigned alternate_function) const override {
    return pins.has_function(static_cast<unsigned>(port - 'A'), pin, alternate_function);
  }

  // Each part is constructed after the parts that it uses.
  Memory memory;
  StartingClock starting_clock;
  Machine machine;
  EventQueue events{machine.timeline};
  Processor processor{machine, Bus::windows_of(bus), *this};
  SystemControl system_control{machine, processor};
  Bus bus{machine, processor, system_control, starting_clock};
  Rcc rcc{machine, processor, starting_clock, *this};
  FlashController flash{machine, processor};
  Dma dma{machine, bus, *this};
  Adcs adcs{machine, dma, *this, *this};
  Exti exti{machine, processor, adcs};
  Timers timers{machine, {dma, adcs, *this}};
  Pins pins{machine, timers, exti};
  PowerControl power{machine, exti, rcc};
  std::deque<Usart> usarts;  ///< by number - 1
  std::deque<Spi> spis;      ///< by number - 1
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

  // Lines to parts that are constructed later.
  std::uint32_t code_address() const override { return processor.code_address(); }
  std::optional<std::uint32_t> program(std::uint32_t address, std::uint32_t value, unsigned size) override {
    return flash.program(address, value, size);
  }
  void hold_up() override { flash.hold_up(); }
  void crystal_failed() override { timers.clock_failed(); }
  void serve_dma() override {
    for (auto& usart : usarts) usart.serve_dma();
    for (auto& one : spis) one.serve_dma();
  }
  void timer_events_changed() override { timers.plan_again(); }
  bool has_function(unsigned port, unsigned pin, unsigned alternate_function) const override {
    return pins.has_function(port, pin, alternate_function);
  }
  bool is_analog(unsigned port, unsigned pin) const override { return pins.is_analog(port, pin); }
  void timer_output(unsigned timer, unsigned line, PinLevel level) override { pins.timer_output(timer, line, level); }

  std::vector<std::unique_ptr<Peripheral>> standalone_parts_;
};

}  // namespace inkwell::virtual_board
