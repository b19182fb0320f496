// Value change dump (IEEE 1364-2005, clause 18) of pin levels and the running exception over board time, for GTKWave
// and similar viewers.
#pragma once

#include <array>
#include <chip/chip.hpp>
#include <chip/pin_name.hpp>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace inkwell::virtual_board {

class Waveform {
 public:
  /// Throws std::runtime_error if the file cannot be written. An empty `pins` selects all pins. The object watches the
  /// pins and exceptions of the chip until its destruction, and `chip` must outlive it.
  Waveform(const std::filesystem::path& path, std::vector<PinName> pins, Chip& chip);
  ~Waveform();
  Waveform(const Waveform&) = delete;
  Waveform& operator=(const Waveform&) = delete;

 private:
  static constexpr unsigned places = 9 * 16;
  void set_time(Ticks when);
  void note_exception(unsigned exception);
  Chip& chip_;
  std::ofstream file_;
  std::array<std::string, places> codes_{};  ///< codes of the written pins, indexed by port and pin
  Ticks written_until_ = 0;
  bool begun_ = false;
};

}  // namespace inkwell::virtual_board
