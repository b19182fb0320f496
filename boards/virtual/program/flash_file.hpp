// The chip's flash in a file, so that a board remembers from run to run what it has stored.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>

#include <local/owned_file.hpp>

namespace inkwell::virtual_board {

/// All bytes of the flash in the order of their addresses, and nothing else. No other program can use the file
/// meanwhile.
class FlashFile {
 public:
  /// Fills `flash` from the file; leaves it as it is if there is none, which save() will make.
  /// @throws std::runtime_error with a sentence if the file is no flash of this chip, is in use, or cannot be read.
  FlashFile(std::filesystem::path path, std::span<std::uint8_t> flash);
  /// The file is whole at any time: another takes its place.
  /// @throws std::runtime_error with a sentence if it cannot be written.
  void save(std::span<const std::uint8_t> flash);

 private:
  std::filesystem::path path_;
  std::optional<local::OwnedFile> file_;
};

}  // namespace inkwell::virtual_board
