#include "boards/stm32f405/core/address_space.hpp"

#include <cstdio>

namespace inkwell::virtual_board {

std::string hexadecimal(std::uint32_t value) {
  char text[16];
  std::snprintf(text, sizeof text, "0x%08X", static_cast<unsigned>(value));
  return text;
}

AddressSpace::Bytes AddressSpace::bytes_at_zero() const {
  switch (at_zero_) {
    case MemoryAtZero::sram1: return sram_.first(sram1_bytes);
    case MemoryAtZero::system: return system_;
    case MemoryAtZero::flash: break;
  }
  return flash_;
}

std::optional<std::uint32_t> AddressSpace::other_address(std::uint32_t address) const {
  const std::uint32_t base = at_zero_ == MemoryAtZero::sram1    ? sram_base
                             : at_zero_ == MemoryAtZero::system ? system_base
                                                                : flash_base;
  const std::size_t bytes = bytes_at_zero().size();
  if (address < bytes) return address + base;
  if (address - base < bytes) return address - base;
  return {};
}

std::uint8_t* AddressSpace::at(std::uint32_t address, std::uint32_t bytes) {
  const auto within = [&](std::uint32_t base, Bytes memory) -> std::uint8_t* {
    const std::uint32_t offset = address - base;
    return address >= base && offset < memory.size() && bytes <= memory.size() - offset ? memory.data() + offset
                                                                                        : nullptr;
  };
  if (address >= sram_base) return within(sram_base, sram_);
  if (address >= system_base) return within(system_base, system_);
  if (address >= ccm_base) return within(ccm_base, ccm_);
  if (address >= flash_base) return within(flash_base, flash_);
  return within(0, bytes_at_zero());
}

std::uint8_t* AddressSpace::ram_at(std::uint32_t address, std::uint32_t bytes) {
  const bool is_ram = address >= sram_base || (address >= ccm_base && address < system_base) ||
                      (at_zero_ == MemoryAtZero::sram1 && address < sram1_bytes);
  return is_ram ? at(address, bytes) : nullptr;
}

}  // namespace inkwell::virtual_board
