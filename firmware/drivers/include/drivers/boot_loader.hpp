// The boot loader in the chip's system memory (AN2606): USB DFU among its ways to write the flash.
#pragma once

namespace inkwell::drivers {

/// Resets the chip; start-up then goes to the boot loader, which stays until power or reset.
[[noreturn]] void start_boot_loader();

/// Whether the run before ended with start_boot_loader(); once.
bool take_boot_loader_wish();

/// For start-up, while clocks and peripherals are as after a reset.
extern "C" [[noreturn]] void enter_boot_loader();

}  // namespace inkwell::drivers
