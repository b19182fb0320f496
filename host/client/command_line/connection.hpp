// Command-line options that select a device or a virtual board.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>

#include <CLI/CLI.hpp>

#include "host/client/device/nearest_name.hpp"
#include "host/client/device/open_arm.hpp"

namespace inkwell::command_line {

/// The command line is wrong. The program exits with code 2.
class UsageError : public device::Error {
 public:
  using Error::Error;
};

/// Selects when the time of a virtual board advances. The option --real-time overrides this selection.
enum class BoardPace : std::uint8_t {
  as_it_can,
  real_time,  ///< synchronized with wall time
  lock_step,  ///< advances while the command waits for the board
  as_asked,   ///< advances only on request through OpenArm::control
};

struct DeviceOptions {
  bool is_virtual = false;
  std::string board;  ///< empty: the board of the ELF
  std::filesystem::path elf;
  std::filesystem::path arm;
  std::filesystem::path flash;
  std::string mode;  ///< empty: the default of the command
  std::uint64_t seed = 1;
  bool real_time = false;
  std::string usbip;          ///< HOST:PORT or unix:PATH
  std::string serial_number;  ///< or name of an arm
  bool take_over = false;
  bool json = false;
  bool is_strict = false;  ///< a virtual board exits when the firmware violates a rule of the chip

  void add_to(CLI::App& app);
  void add_board_to(CLI::App& app);
  /// Throws UsageError.
  device::Address address() const;
  device::VirtualBoardOptions virtual_board(device::SimulationMode default_mode, BoardPace pace) const;
};

/// Opens the selected device.
device::OpenArm connect(const DeviceOptions& options, BoardPace pace = BoardPace::as_it_can,
                        device::SimulationMode default_mode = device::SimulationMode::fast);

template <class Value>
struct Typed {
  Value value;
  std::optional<device::OpenArm> connection;
};

/// Parses with `read()`. Opens the device only for an unknown name, which the device's force law may define.
template <class Read>
Typed<std::invoke_result_t<Read>> read_typed(const DeviceOptions& options, Read read,
                                             BoardPace pace = BoardPace::as_it_can) {
  try {
    return {read(), std::nullopt};
  } catch (const device::UnknownName& unknown) {
    try {
      auto connection = connect(options, pace);
      return {read(), std::move(connection)};
    } catch (const device::Error&) {
      throw UsageError(unknown.what());
    }
  } catch (const device::Error& error) {
    throw UsageError(error.what());
  }
}

}  // namespace inkwell::command_line
