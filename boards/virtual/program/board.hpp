// The board as a whole: chip, plant and USB wired together. It lives on the simulation's thread.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include <chip/chip.hpp>
#include <debugger/symbols.hpp>
#include <debugger/waveform.hpp>
#include <injection/injector.hpp>
#include <plant/plant.hpp>
#include <virtual_usb/virtual_usb.hpp>

#include "flash_file.hpp"
#include "options.hpp"
#include "profile.hpp"

namespace inkwell::virtual_board {

class Board {
 public:
  /// Reads the arm, programs the flash and switches the power on.
  /// @throws std::runtime_error with a sentence if the arm, the ELF or the address of USB/IP is refused.
  /// `usbip`, `on_usb_request` and `is_ending`: see VirtualUsb.
  Board(const Options& options, const local::SocketAddress& usbip, std::function<void()> on_usb_request,
        std::function<bool()> is_ending);
  ~Board();
  Board(const Board&) = delete;
  Board& operator=(const Board&) = delete;

  /// Runs until board time `when`, or until the firmware ends or locks up.
  Stop run_until(Ticks when);
  /// The USB cable: with it comes VBUS, for the core and for the pin that senses it.
  void plug(bool in);
  /// Presses the board's reset button.
  void reset();

  Chip& chip() { return chip_; }
  const board::Facts& facts() const { return facts_; }
  Plant& plant() { return plant_; }
  Injector& injector() { return *injector_; }
  VirtualUsb& usb() { return *usb_; }
  Trace& trace() { return trace_; }
  struct ControlPeriod {
    std::uint64_t number = 0;  ///< from 0 on since the last reset
    Ticks began = 0;
  };
  /// The newest. Firmware whose core was never kept from its control interrupt counts them alike.
  const ControlPeriod& control_period() const { return control_period_; }
  const Profile& profile() const { return profile_; }
  /// The function that holds `address`; empty if the ELF does not say.
  std::string name_of_code(std::uint32_t address) const { return symbols_.name(address); }
  Truth truth() { return plant_.truth(chip_.now()); }
  bool locked_up() const { return locked_up_; }

 private:
  void console(std::uint8_t byte);
  /// What the firmware has stored goes into the file, once it has stored all of it.
  void follow_flash();
  Stop run_chip_until(Ticks when);
  std::function<void(std::uint32_t address, std::uint64_t cycles)> observer(const Options& options);

  const std::filesystem::path elf_;
  Symbols symbols_;
  const board::Facts& facts_;
  Plant plant_;
  Wires wires_{plant_};
  Chip chip_;
  std::optional<FlashFile> flash_file_;
  std::uint64_t flash_seen_ = 0, flash_saved_ = 0;  ///< operations of the flash
  std::optional<Waveform> waveform_;
  std::optional<VirtualUsb> usb_;     ///< there from construction to destruction
  std::optional<Injector> injector_;  ///< likewise
  Trace trace_;
  ControlPeriod control_period_;
  Profile profile_;
  std::string console_line_;
  bool locked_up_ = false;
};

}  // namespace inkwell::virtual_board
