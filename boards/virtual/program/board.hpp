// The complete board: chip, plant and USB. Only the simulation thread uses the board.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "boards/stm32f405/debugger/symbols.hpp"
#include "boards/stm32f405/debugger/waveform.hpp"
#include "boards/stm32f405/wiring/chip.hpp"
#include "boards/virtual/injection/injector.hpp"
#include "boards/virtual/plant/plant.hpp"
#include "boards/virtual/usb/virtual_usb.hpp"

#include "boards/virtual/program/flash_file.hpp"
#include "boards/virtual/program/options.hpp"
#include "boards/virtual/program/profile.hpp"

namespace inkwell::virtual_board {

class Board {
 public:
  /// Reads the arm description, programs the flash and switches the power on. See VirtualUsb for `usbip`,
  /// `on_usb_request` and `is_ending`.
  /// @throws std::runtime_error with an error sentence if the arm, the ELF file or the USB/IP address is invalid.
  Board(const Options& options, const local::SocketAddress& usbip, std::function<void()> on_usb_request,
        std::function<bool()> is_ending);
  ~Board();
  Board(const Board&) = delete;
  Board& operator=(const Board&) = delete;

  /// Runs until board time `when`, an exit of the firmware, or a lock-up.
  Stop run_until(Ticks when);
  /// Plugs in or unplugs the USB cable. The cable supplies VBUS to the OTG_FS core and to the sense pin.
  void plug(bool in);
  void reset();

  Chip& chip() { return chip_; }
  const board::Facts& facts() const { return facts_; }
  Plant& plant() { return plant_; }
  Injector& injector() { return *injector_; }
  VirtualUsb& usb() { return *usb_; }
  Trace& trace() { return trace_; }
  struct ControlPeriod {
    std::uint64_t number = 0;  ///< from 0 since the last reset
    Ticks began = 0;
  };
  /// The newest control period. The number equals the firmware's period count, unless the firmware has missed a control
  /// interrupt.
  const ControlPeriod& control_period() const { return control_period_; }
  const Profile& profile() const { return profile_; }
  /// Returns the name of the function at `address`, or an empty name.
  std::string name_of_code(std::uint32_t address) const { return symbols_.name(address); }
  Truth truth() { return plant_.truth(chip_.now()); }
  bool locked_up() const { return locked_up_; }

 private:
  void console(std::uint8_t byte);
  /// Saves the flash file after each flash operation.
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
  std::optional<VirtualUsb> usb_;     ///< exists from construction to destruction
  std::optional<Injector> injector_;  ///< same lifetime as usb_
  Trace trace_;
  ControlPeriod control_period_;
  Profile profile_;
  std::string console_line_;
  bool locked_up_ = false;
};

}  // namespace inkwell::virtual_board
