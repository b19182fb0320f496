// Storage of the chip's flash in a file, so that its contents survive the program.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>

#include <local/owned_file.hpp>

namespace inkwell::virtual_board {

/// The file contains only the bytes of the flash, in address order. The file is locked against other programs.
class FlashFile {
 public:
  /// Fills `flash` from the file. If the file does not exist, `flash` does not change, and save() creates the file.
  /// @throws std::runtime_error with a sentence if the file is not a flash image of this chip, is in use, or is
  /// unreadable.
  FlashFile(std::filesystem::path path, std::span<std::uint8_t> flash);
  /// Replaces the file atomically.
  /// @throws std::runtime_error with a sentence if the file cannot be written.
  void save(std::span<const std::uint8_t> flash);

 private:
  std::filesystem::path path_;
  std::optional<local::OwnedFile> file_;
};

}  // namespace inkwell::virtual_board
