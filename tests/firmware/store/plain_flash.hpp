// The two sectors of a flash memory, without power losses.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "firmware/store/flash_log.hpp"

namespace inkwell::test {

class PlainFlash final : public link::FlashMemory {
 public:
  static constexpr std::size_t words_of_chip = 0x4000 / 4;  ///< words of a sector of the chip

  explicit PlainFlash(std::size_t sector_words = words_of_chip) {
    for (auto& sector : sectors) sector.assign(sector_words, 0xFFFF'FFFF);
  }
  std::span<const std::uint32_t> sector(std::size_t number) const override { return sectors[number]; }
  bool program(std::size_t sector, std::size_t word, std::uint32_t value) override {
    ++words_programmed;
    std::uint32_t& cell = sectors.at(sector).at(word);
    cell &= value;
    return cell == value && !is_worn;
  }
  void erase(std::size_t sector) override { std::ranges::fill(sectors.at(sector), 0xFFFF'FFFF); }

  std::array<std::vector<std::uint32_t>, protocol::store_sectors> sectors;
  unsigned words_programmed = 0;
  bool is_worn = false;  ///< programming fails
};

}  // namespace inkwell::test
