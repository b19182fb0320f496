// The firmware's ELF: what lies where in it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

namespace inkwell::crash {

class FirmwareImage {
 public:
  /// Throws device::Error if the file cannot be read or is no program for an ARM processor.
  explicit FirmwareImage(const std::filesystem::path& elf);
  ~FirmwareImage();
  FirmwareImage(FirmwareImage&&) noexcept;

  /// The checksum that the build has sealed it with; nothing if it has none.
  std::optional<std::uint32_t> check() const;

  /// Function, file and line of an instruction, as far as the ELF tells; empty if no function lies there.
  std::string place(std::uint32_t address) const;

 private:
  struct Reader;
  std::unique_ptr<Reader> reader_;
};

}  // namespace inkwell::crash
