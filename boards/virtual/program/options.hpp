// The command line of virtual-board.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include "boards/known/boards.hpp"
#include "boards/stm32f405/debugger/waveform.hpp"
#include "boards/stm32f405/wiring/chip.hpp"
#include "boards/virtual/injection/injection.hpp"

#include "boards/virtual/program/port_option.hpp"
#include "boards/virtual/program/serial_number.hpp"
#include "boards/virtual/program/uart_links.hpp"

namespace inkwell::virtual_board {

struct Options {
  std::filesystem::path elf;
  const board::Facts* board = &board::default_board;
  std::filesystem::path arm;
  std::filesystem::path flash;  ///< empty: the flash contents are discarded at exit
  PortOption usbip;
  PortOption control;
  std::optional<PortOption> gdb;
  std::vector<UartOption> uarts;
  std::filesystem::path waveform;      ///< empty: no file is written
  std::vector<PinName> waveform_pins;  ///< empty: all
  Mode mode = Mode::fast;
  Pricing pricing = Pricing::likely;
  std::optional<std::uint32_t> crystal_Hz;  ///< std::nullopt: the board's frequency
  std::int32_t crystal_ppm = 0;             ///< deviation of the crystal from its nominal frequency, positive if fast
  std::uint32_t low_speed_internal_Hz = 32'000;
  bool from_boot_loader = false;
  bool boot_loader = false;      ///< BOOT0 is high at power-on
  unsigned brown_out_level = 0;  ///< setting in the option bytes
  bool slowest_flash = false;    ///< longest instead of typical times to erase and program
  double host_clock_ppm = 0.0;   ///< deviation of the USB host's clock from board time, positive if fast
  bool real_time = false;
  std::filesystem::path clock;  ///< file of a clock that several boards share; empty: a separate clock
  bool lock_step = false;       ///< board time passes only while all programs that use the device wait for it
  std::uint64_t seed = 1;
  UniqueId unique_id{};           ///< of the chip; determines the serial number
  std::optional<double> seconds;  ///< board time in seconds after which the program exits
  std::vector<Injection> injections;
  bool paused = false;
  std::optional<std::filesystem::path> profile;  ///< file for the profile of the longest interrupt
  bool strict = false;                           ///< the program exits when the firmware first breaks a rule of the
                                                 ///< chip
};

/// Returns the options or an exit code. The exit code is 0 after --help and 2 after an invalid option. Prints errors on
/// stderr.
struct CommandLine {
  std::optional<Options> options;
  int exit_code = 0;
};
CommandLine read_command_line(int argc, char** argv);

}  // namespace inkwell::virtual_board
