// Options of the emulated chip.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <string>

#include "boards/stm32f405/timing/costs.hpp"

namespace inkwell::virtual_board {

enum class Mode : std::uint8_t {
  exact,  ///< interrupts can occur at any instruction
  fast,   ///< interrupts occur between basic blocks; several times faster
};

struct ChipOptions {
  Mode mode = Mode::fast;
  Pricing pricing = Pricing::likely;
  std::uint32_t crystal_Hz = 8'000'000;          ///< nominal frequency of HSE
  std::int32_t crystal_ppm = 0;                  ///< deviation from the nominal frequency
  std::uint32_t low_speed_internal_Hz = 32'000;  ///< LSI: 17 to 47 kHz (data sheet)
  unsigned brown_out_level = 0;                  ///< option bytes: 0 (off, as in a new chip) to 3
  bool slowest_flash = false;  ///< longest erase and program times of the data sheet instead of the typical times
  std::array<std::uint32_t, 3> unique_id{0x0031'0042, 0x3133'5107, 0x3932'3539};  ///< RM0090, "Unique device ID"
  std::uint32_t random_seed = 1;  ///< for the RNG peripheral and for flash operations that a reset interrupts
  /// The chip calls this function with each log line, without the newline. By default the log is written to stderr.
  std::function<void(const std::string&)> log;
  /// Returns the name of the function at `address`, or an empty string. Log lines contain this name.
  std::function<std::string(std::uint32_t address)> name_of_code;
  /// In exact mode, the processor calls this function before each instruction. `cycles` is the cycle counter of the
  /// core.
  std::function<void(std::uint32_t address, std::uint64_t cycles)> on_instruction;
};

}  // namespace inkwell::virtual_board
