// Names of functions, from the symbol table of an ELF file.
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
  /// Of an ELF file that the chip has taken. A file without symbols (stripped, or damaged there) has no names.
  explicit Symbols(const std::filesystem::path& elf);

  /// The function at `address` and how far into it that is, such as "main+0x12"; empty if no function is there.
  std::string name(std::uint32_t address) const;

 private:
  struct Function {
    std::uint32_t address, bytes;
    std::string name;
  };
  std::vector<Function> functions_;  ///< by address
};

/// The text, ended by a zero, that an ELF file has under this name; empty if it has none.
std::string text_in_elf(const std::filesystem::path& elf, std::string_view name);

}  // namespace inkwell::virtual_board
