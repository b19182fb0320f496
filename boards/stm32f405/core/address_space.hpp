// Access to flash, SRAM, CCM and system memory. The class Memory owns the bytes (memory/memory.hpp).
#pragma once

#include <cstdint>
#include <cstring>
#include <optional>
#include <span>
#include <string>

#include "boards/stm32f405/core/memory_map.hpp"

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

  /// Selects the memory that is also mapped at address 0.
  void map_at_zero(MemoryAtZero memory) { at_zero_ = memory; }
  MemoryAtZero at_zero() const { return at_zero_; }
  /// Returns the bytes of the memory at address 0.
  Bytes bytes_at_zero() const;
  /// Returns the other address of the byte at `address`, if the byte is mapped twice.
  std::optional<std::uint32_t> other_address(std::uint32_t address) const;
  bool is_in_flash(std::uint32_t address) const {
    return address - flash_base < flash_bytes || (at_zero_ == MemoryAtZero::flash && address < flash_bytes);
  }

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
  MemoryAtZero at_zero_ = MemoryAtZero::flash;
};

}  // namespace inkwell::virtual_board
