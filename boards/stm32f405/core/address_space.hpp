// Access to flash, SRAM, CCM and system memory. The class Memory owns the bytes (memory/memory.hpp).
#pragma once

#include <cstdint>
#include <cstring>
#include <span>
#include <string>

namespace inkwell::virtual_board {

/// Formats a number in hexadecimal, for example 0x08000000.
std::string hexadecimal(std::uint32_t value);

class AddressSpace {
 public:
  using Bytes = std::span<std::uint8_t>;
  /// The sizes must match memory_map.hpp.
  AddressSpace(Bytes flash, Bytes sram, Bytes ccm, Bytes system)
      : flash_(flash), sram_(sram), ccm_(ccm), system_(system) {}

  std::uint8_t* flash() { return flash_.data(); }
  std::uint8_t* sram() { return sram_.data(); }
  std::uint8_t* ccm() { return ccm_.data(); }
  std::uint8_t* system() { return system_.data(); }

  /// Returns a pointer to the memory at `address`. Returns nullptr if no memory contains all `bytes` bytes.
  std::uint8_t* at(std::uint32_t address, std::uint32_t bytes);
  const std::uint8_t* at(std::uint32_t address, std::uint32_t bytes) const {
    return const_cast<AddressSpace*>(this)->at(address, bytes);
  }
  /// Returns the result of at() for SRAM and CCM, otherwise nullptr.
  std::uint8_t* ram_at(std::uint32_t address, std::uint32_t bytes);
  std::uint32_t word(std::uint32_t address) const {
    std::uint32_t value = 0;
    if (const auto* memory = at(address, 4)) std::memcpy(&value, memory, 4);
    return value;
  }
  std::uint16_t half_word(std::uint32_t address) const {
    std::uint16_t value = 0;
    if (const auto* memory = at(address, 2)) std::memcpy(&value, memory, 2);
    return value;
  }

 private:
  Bytes flash_, sram_, ccm_, system_;
};

}  // namespace inkwell::virtual_board
