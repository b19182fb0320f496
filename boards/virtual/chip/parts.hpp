// The chip as a parts list.
#pragma once

#include <deque>
#include <string>

#include "adc.hpp"
#include "bus.hpp"
#include "dma.hpp"
#include "execution.hpp"
#include "exti.hpp"
#include "flash.hpp"
#include "machine.hpp"
#include "pins.hpp"
#include "processor.hpp"
#include "rcc.hpp"
#include "small_peripherals.hpp"
#include "system_control.hpp"
#include "timers.hpp"
#include "usart.hpp"
#include "watchdogs.hpp"

namespace inkwell::virtual_board {

struct ChipParts {
  ChipParts(Circuit& circuit, const ChipOptions& options);
  void add_outside_peripheral(std::uint32_t base, std::uint32_t size, const std::string& name, Peripheral& peripheral);

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
  IndependentWatchdog independent_watchdog{machine};
  WindowWatchdog window_watchdog{machine};
  PowerControl power{machine};
  CrcUnit crc;
  RandomNumbers random_numbers{machine.options.random_seed};
  Processor processor{machine, bus};
  Execution execution{machine, processor, bus, system_control, rcc};

 private:
  void put(std::uint32_t base, const std::string& name, Peripheral& peripheral, std::uint32_t enable_register,
           unsigned enable_bit);
};

}  // namespace inkwell::virtual_board
