// ST's USB boot loader in the chip: DFU 1.1 with ST's extensions (AN3156). Every STM32F405 contains this boot loader in
// its system memory, which flash writes cannot change.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "host/client/device/control_channel.hpp"
#include "host/client/firmware_update/image.hpp"

namespace inkwell::firmware_update {

struct Sector {
  std::uint32_t address, bytes;
  bool operator==(const Sector&) const = default;
};

/// Parses the sectors in the name of an alternate setting (UM0424): "@Internal Flash  /0x08000000/04*016Kg,01*064Kg".
/// Returns an empty list if the name has another format.
std::vector<Sector> parse_memory_layout(std::string_view name);

/// Returns the sectors of `all` that the image uses.
std::vector<Sector> sectors_of(const Image& image, const std::vector<Sector>& all);

/// Throws Error with the failure that the boot loader reports. ControlChannel may throw other errors.
class BootLoader {
 public:
  static constexpr std::size_t block_bytes = 2048, option_bytes = 16;

  explicit BootLoader(device::ControlChannel& channel) : channel_(channel) {}

  /// Puts the boot loader into the idle state. Then reads the list of flash sectors.
  void start();
  const std::vector<Sector>& sectors() const { return sectors_; }

  void erase(std::uint32_t sector_address);
  /// Writes at most one block into erased flash.
  void write(std::uint32_t address, std::span<const std::byte> data);
  std::vector<std::byte> read(std::uint32_t address, std::size_t bytes);

  std::array<std::byte, option_bytes> read_options();
  /// Writes the option bytes. The boot loader then resets the chip, which starts the firmware.
  void write_options(std::span<const std::byte, option_bytes> options);
  /// Starts the program at the beginning of the flash.
  void leave();

 private:
  struct Status;
  Status status();
  void make_idle();
  void set_address(std::uint32_t address);
  void download(std::uint16_t block, std::span<const std::byte> data);
  void wait_until_done();

  device::ControlChannel& channel_;
  std::vector<Sector> sectors_;
};

}  // namespace inkwell::firmware_update
