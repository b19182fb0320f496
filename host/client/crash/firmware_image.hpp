// The firmware's ELF file: names and source locations of addresses.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

namespace inkwell::crash {

class FirmwareImage {
 public:
  /// Throws device::Error if the file cannot be read or is not a program for an ARM processor.
  explicit FirmwareImage(const std::filesystem::path& elf);
  ~FirmwareImage();
  FirmwareImage(FirmwareImage&&) noexcept;

  /// Checksum from the build; std::nullopt if the image has no checksum.
  std::optional<std::uint32_t> check() const;

  /// Function, file and line of an instruction, as far as the ELF file contains them; empty if there is no function.
  std::string source_location(std::uint32_t address) const;

 private:
  struct Reader;
  std::unique_ptr<Reader> reader_;
};

}  // namespace inkwell::crash
