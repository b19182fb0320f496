// The boot loader in the chip's system memory (AN2606) can write the flash through USB DFU and other interfaces.
#pragma once

namespace inkwell::drivers {

/// Resets the chip. After the reset, the boot loader runs until power-off or another reset.
[[noreturn]] void start_boot_loader();

/// Returns true if start_boot_loader() has caused the last reset. Only the first call returns true.
bool take_boot_loader_wish();

/// Enters the boot loader. Call this function during start-up, while clocks and peripherals are in their reset state.
extern "C" [[noreturn]] void enter_boot_loader();

}  // namespace inkwell::drivers
