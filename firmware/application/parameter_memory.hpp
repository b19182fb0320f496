// Flash memory for the record log of parameters (flash_log.hpp).
#pragma once

#include "firmware/store/flash_log.hpp"

#include "firmware/application/memory.hpp"
#include "firmware/application/parts.hpp"

namespace inkwell::application {

class ParameterMemory final : public link::FlashMemory {
 public:
  std::span<const std::uint32_t> sector(std::size_t number) const override { return {begin(number), words}; }
  bool program(std::size_t sector, std::size_t word, std::uint32_t value) override {
    return parameter_flash.program(begin(sector) + word, value);
  }
  void erase(std::size_t sector) override { parameter_flash.erase(begin(sector)); }

 private:
  static constexpr std::size_t words = 0x4000 / sizeof(std::uint32_t);
  static std::uint32_t* begin(std::size_t sector) { return parameter_store + sector * words; }
};

}  // namespace inkwell::application
