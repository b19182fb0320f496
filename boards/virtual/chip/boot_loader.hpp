// Replacement for ST's boot loader in the system memory of the chip (AN2606).
#pragma once

#include <cstdint>

#include <chip/chip.hpp>
#include <chip/memory_map.hpp>

namespace inkwell::virtual_board {

/// Address at which the boot loader executes its command "Go".
inline constexpr std::uint32_t loader_go = system_base + 0x200;
/// Entry address of the boot loader, and RAM buffer for the data to be programmed.
inline constexpr std::uint32_t loader_entry = system_base + 8, loader_buffer = sram_base + 0x100;

/// Semihosting call by which the loader requests an order. Arm reserves this number for applications. R0 returns
/// LoaderOrder::Kind, R1 the address, R2 the word or the address of the data, and R3 the number of words.
inline constexpr std::uint32_t semihosting_poll_order = 0x101;

/// Writes the boot loader to the beginning of the system memory.
void put_boot_loader(std::uint8_t* system, std::uint32_t crystal_Hz);

}  // namespace inkwell::virtual_board
