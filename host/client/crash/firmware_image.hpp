// Reads the names and source locations of addresses from the firmware's ELF file.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

namespace inkwell::crash {

class FirmwareImage {
 public:
  /// Throws device::Error if the file is not a readable ARM program.
  explicit FirmwareImage(const std::filesystem::path& elf);
  ~FirmwareImage();
  FirmwareImage(FirmwareImage&&) noexcept;

  /// Returns the checksum from the build, or std::nullopt if the image has no checksum.
  std::optional<std::uint32_t> check() const;

  /// Returns function, file and line of an instruction, as far as they are known. Returns an empty text outside all
  /// functions.
  std::string source_location(std::uint32_t address) const;

 private:
  struct Reader;
  std::unique_ptr<Reader> reader_;
};

}  // namespace inkwell::crash
