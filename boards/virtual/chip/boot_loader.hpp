// What stands for the boot loader in the chip's system memory (AN2606).
#pragma once

#include <chip/chip.hpp>
#include <cstdint>

namespace inkwell::virtual_board {

/// Where the loader starts the program in the flash, as after its command "Go".
inline constexpr std::uint32_t loader_go = system_base + 0x200;

/// Writes it to the first byte of the system memory. Entered by its vectors it says by semihosting that there is none,
/// and waits for a reset.
void put_boot_loader(std::uint8_t* system, std::uint32_t crystal_Hz);

}  // namespace inkwell::virtual_board
