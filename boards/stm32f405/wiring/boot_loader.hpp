// Replacement for ST's boot loader in the system memory of the chip (AN2606).
#pragma once

#include <cstdint>

#include "boards/stm32f405/core/memory_map.hpp"
#include "boards/stm32f405/wiring/chip.hpp"

namespace inkwell::virtual_board {

/// Address of the boot loader's code for the command "Go".
inline constexpr std::uint32_t loader_go = system_base + 0x200;
/// Entry address of the boot loader, and RAM buffer for the data to be programmed.
inline constexpr std::uint32_t loader_entry = system_base + 8, loader_buffer = sram_base + 0x100;

/// Semihosting call for the next order. Arm reserves the number 0x101 for applications. The call returns
/// LoaderOrder::Kind in R0, the address in R1, the word or the data address in R2, and the number of words in R3.
inline constexpr std::uint32_t semihosting_poll_order = 0x101;

/// Writes the boot loader to the beginning of the system memory.
void put_boot_loader(std::uint8_t* system, std::uint32_t crystal_Hz);

}  // namespace inkwell::virtual_board
