// Reports the CPU fault that caused a lock-up.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>
#include "boards/stm32f405/wiring/chip.hpp"

#include "boards/stm32f405/debugger/symbols.hpp"

namespace inkwell::virtual_board {

/// Reads a word of memory without side effects.
using MemoryReader = std::function<std::uint32_t(std::uint32_t address)>;

/// Returns up to `limit` probable callers, innermost first. The candidates are LR and the first 4096 bytes of the
/// stack. A candidate must be the address after a call instruction. Old return addresses on the stack can lead to wrong
/// results.
std::vector<std::uint32_t> guess_callers(const CoreRegisters& registers, const MemoryReader& word, std::size_t limit);

/// Returns text lines that describe the first CPU fault of a lock-up. `elf` is part of the suggested addr2line command.
std::vector<std::string> explain_cpu_fault(const Chip& chip, const Symbols& symbols, const std::filesystem::path& elf);

}  // namespace inkwell::virtual_board
