// A lock-up explained: its first fault with registers, function and the way there.
#pragma once

#include <chip/chip.hpp>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include <debugger/symbols.hpp>

namespace inkwell::virtual_board {

/// Reads a word of memory without any effect.
using MemoryReader = std::function<std::uint32_t(std::uint32_t address)>;

/// Where the code at `registers` was probably called from, the innermost first: return addresses in LR and on the
/// stack, that is, words that point behind a call. What an earlier call left on the stack looks the same. At most
/// `limit`.
std::vector<std::uint32_t> guess_callers(const CoreRegisters& registers, const MemoryReader& word, std::size_t limit);

/// Lines about the fault that a lock-up began with. `elf` is named in a command that tells source lines.
std::vector<std::string> explain_fault(const Chip& chip, const Symbols& symbols, const std::filesystem::path& elf);

}  // namespace inkwell::virtual_board
