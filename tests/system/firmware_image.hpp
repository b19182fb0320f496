// Symbol addresses in the firmware of the virtual board.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace inkwell::tests {

/// A function or variable.
struct FirmwareSymbol {
  std::uint32_t address, size_bytes;
  bool contains(std::uint32_t other) const { return other >= address && other - address < size_bytes; }
};

/// Returns the symbol whose mangled name contains `name`, and fails the test unless exactly one symbol matches.
FirmwareSymbol find_symbol(std::string_view name);
inline std::uint32_t firmware_symbol(std::string_view name) { return find_symbol(name).address; }

/// Returns the address of the loop in which the firmware waits for a requested reset.
std::uint32_t endless_loop_address();

/// Returns the compiler version without its last number, such as "12.2".
std::string firmware_compiler_version();

}  // namespace inkwell::tests
