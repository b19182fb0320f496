// Writes pin levels and the running exception to a value change dump (IEEE 1364-2005, clause 18). Viewers such as
// GTKWave can display this file format.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>
#include "boards/stm32f405/peripherals/pin_name.hpp"
#include "boards/stm32f405/wiring/chip.hpp"

namespace inkwell::virtual_board {

class Waveform {
 public:
  /// Throws std::runtime_error if the file cannot be written. An empty `pins` selects all pins. A Waveform records pins
  /// and exceptions from its construction to its destruction. `chip` must outlive the Waveform.
  Waveform(const std::filesystem::path& path, std::vector<PinName> pins, Chip& chip);
  ~Waveform();
  Waveform(const Waveform&) = delete;
  Waveform& operator=(const Waveform&) = delete;

 private:
  static constexpr unsigned pin_count = 9 * 16;
  void set_time(Ticks when);
  void note_exception(unsigned exception);
  Chip& chip_;
  std::ofstream file_;
  std::array<std::string, pin_count> codes_{};  ///< codes of the written pins, indexed by port and pin
  Ticks written_until_ = 0;
  bool begun_ = false;
};

}  // namespace inkwell::virtual_board
