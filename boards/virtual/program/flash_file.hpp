// Stores the contents of the chip's flash in a file.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>

#include "host/client/local/owned_file.hpp"

namespace inkwell::virtual_board {

/// A flash file contains only the bytes of the flash, in address order. A file lock prevents use by another program.
class FlashFile {
 public:
  /// Copies the contents of the file to `flash`. If the file does not exist, `flash` does not change.
  /// @throws std::runtime_error with an error sentence if the file is not a flash image of this chip, is in use, or is
  /// unreadable.
  FlashFile(std::filesystem::path path, std::span<std::uint8_t> flash);
  /// Replaces the file atomically.
  /// @throws std::runtime_error with an error sentence if the file cannot be written.
  void save(std::span<const std::uint8_t> flash);

 private:
  std::filesystem::path path_;
  std::optional<local::OwnedFile> file_;
};

}  // namespace inkwell::virtual_board
