// Cyclic redundancy check of words, polynomial 0x04C11DB7 (RM0090, "CRC calculation unit").
#pragma once

#include "boards/stm32f405/memory/register_block.hpp"

namespace inkwell::virtual_board {

struct CrcRegisters {
  struct : Register {
    Field dr{"DR", 0, 32};
  } dr{{"DR", 0x00, 0xFFFF'FFFF}};
  struct : Register {
    Field idr{"IDR", 0, 8};
  } idr{{"IDR", 0x04}};
  struct : Register {
    Field reset{"RESET", 0, 1, Access::w};
  } cr{{"CR", 0x08}};
};
inline constexpr CrcRegisters crc;

class CrcUnit final : public RegisterBlock {
 public:
  void reset() override {
    data_ = crc.dr.reset_value;
    independent_ = 0;
  }

 protected:
  std::uint32_t read_word(std::uint32_t offset) override {
    return offset == crc.dr ? data_ : offset == crc.idr ? independent_ : 0;
  }
  void write_word(std::uint32_t offset, std::uint32_t value) override {
    if (offset == crc.idr) independent_ = crc.idr.idr.of(value);
    if (offset == crc.cr && crc.cr.reset.in(value)) data_ = crc.dr.reset_value;
    if (offset == crc.dr) add(value);
  }
  std::span<const MapEntry> registers() const override { return shown<crc>(); }

 private:
  void add(std::uint32_t word) {
    constexpr std::uint32_t polynomial = 0x04C1'1DB7, top = 0x8000'0000;
    data_ ^= word;
    for (int bit = 0; bit < 32; ++bit) data_ = (data_ & top) != 0 ? data_ << 1 ^ polynomial : data_ << 1;
  }
  std::uint32_t data_ = crc.dr.reset_value, independent_ = 0;
};

}  // namespace inkwell::virtual_board
