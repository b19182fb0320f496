// Function names from the symbol table of an ELF file.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace inkwell::virtual_board {

class Symbols {
 public:
  Symbols() = default;
  /// Reads the symbol table of an ELF file. Without a valid symbol table, name() returns an empty string.
  explicit Symbols(const std::filesystem::path& elf);

  /// Returns the function and offset of `address`, such as "main+0x12", or an empty string.
  std::string name(std::uint32_t address) const;

 private:
  struct Function {
    std::uint32_t address, bytes;
    std::string name;
  };
  std::vector<Function> functions_;  ///< sorted by address
};

/// Returns the zero-terminated text at the symbol `name` in an ELF file, or an empty string.
std::string text_in_elf(const std::filesystem::path& elf, std::string_view name);

}  // namespace inkwell::virtual_board
