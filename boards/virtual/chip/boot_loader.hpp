// What stands for the boot loader in the chip's system memory (AN2606).
#pragma once

#include <cstdint>

#include <chip/chip.hpp>
#include <chip/memory_map.hpp>

namespace inkwell::virtual_board {

/// Where the loader starts the program in the flash, as after its command "Go".
inline constexpr std::uint32_t loader_go = system_base + 0x200;
/// Where it begins, and the RAM in which it keeps what is to be programmed.
inline constexpr std::uint32_t loader_entry = system_base + 8, loader_buffer = sram_base + 0x100;

/// The semihosting call by which it asks what to do next, one of those that Arm leaves to applications. R0 to R3 of the
/// answer are the kind of a LoaderOrder, its address, its word or the place of its data, and the number of words.
inline constexpr std::uint32_t semihosting_ask_for_order = 0x101;

/// Writes it to the first byte of the system memory.
void put_boot_loader(std::uint8_t* system, std::uint32_t crystal_Hz);

}  // namespace inkwell::virtual_board
