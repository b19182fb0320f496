// The command line of virtual-board.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include <chip/chip.hpp>
#include <debugger/waveform.hpp>
#include <injection/injection.hpp>
#include <known/boards.hpp>

#include "port_option.hpp"
#include "serial_number.hpp"
#include "uart_links.hpp"

namespace inkwell::virtual_board {

struct Options {
  std::filesystem::path elf;
  const board::Facts* board = &board::default_board;
  std::filesystem::path arm;
  std::filesystem::path flash;  ///< empty: the flash is forgotten at the end
  PortOption usbip;
  PortOption control;
  std::optional<PortOption> gdb;
  std::vector<UartOption> uarts;
  std::filesystem::path waveform;      ///< empty: none is written
  std::vector<PinName> waveform_pins;  ///< empty: all
  Mode mode = Mode::fast;
  Pricing pricing = Pricing::likely;
  std::optional<std::uint32_t> crystal_Hz;  ///< none: the board's
  std::int32_t crystal_ppm = 0;             ///< the crystal swings faster than its name by so many parts in a million
  std::uint32_t low_speed_internal_Hz = 32'000;
  bool from_boot_loader = false;
  bool boot_loader = false;      ///< BOOT0 is held while the power comes on
  unsigned brown_out_level = 0;  ///< of the option bytes
  bool slowest_flash = false;    ///< the longest times to erase and program, not the usual
  double host_clock_ppm = 0.0;   ///< the USB host's clock is faster than board time by so many parts in a million
  bool real_time = false;
  std::filesystem::path clock;    ///< file of a clock that several boards share; empty: a separate clock
  bool lock_step = false;         ///< board time passes only while the programs that use the device wait for it
  std::uint64_t seed = 1;         ///< of all noise
  UniqueId unique_id{};           ///< of the chip, and so its serial number
  std::optional<double> seconds;  ///< of board time, after which the program ends
  std::vector<Injection> injections;
  bool paused = false;
  std::optional<std::filesystem::path> profile;  ///< file for the longest interrupt, instruction by instruction
  bool strict = false;                           ///< the first broken rule of the chip ends the program
};

/// The options, or the exit code if the program is to end now: 0 after --help, 2 after a wrong option, which
/// has been explained on stderr.
struct CommandLine {
  std::optional<Options> options;
  int exit_code = 0;
};
CommandLine read_command_line(int argc, char** argv);

}  // namespace inkwell::virtual_board
