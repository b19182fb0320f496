// The options that say which device is meant, and the way to it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>

#include <CLI/CLI.hpp>

#include <device/nearest_name.hpp>
#include <device/open_arm.hpp>

namespace inkwell::command_line {

/// A mistake in what was typed; the program ends with exit code 2.
class UsageError : public device::Error {
 public:
  using Error::Error;
};

/// How a virtual board's time passes, unless --real-time was given.
enum class BoardPace : std::uint8_t {
  as_it_can,
  real_time,  ///< with the clock on the wall
  lock_step,  ///< only while the command, in one thread, waits for a pose or a request
  as_asked,   ///< stands still from its first instruction on, but while OpenArm::control lets it pass
};

struct DeviceOptions {
  bool is_virtual = false;
  std::string board;  ///< empty: the one that the ELF is for
  std::filesystem::path elf;
  std::filesystem::path arm;
  std::filesystem::path flash;
  std::string mode;  ///< empty: the command's own choice
  std::uint64_t seed = 1;
  bool real_time = false;
  std::string usbip;  ///< HOST:PORT or unix:PATH
  std::string serial_number;
  bool take_over = false;
  bool json = false;
  bool is_strict = false;  ///< a virtual board ends when the firmware does what silicon would not bear

  void add_to(CLI::App& app);
  /// Throws UsageError.
  device::Address address() const;
  device::VirtualBoardOptions virtual_board(device::SimulationMode default_mode, BoardPace pace) const;
};

/// Opens the device that the options name, and takes it over if they say so. With --arm, a virtual board's firmware
/// gets that arm's parameters.
device::OpenArm connect(const DeviceOptions& options, BoardPace pace = BoardPace::as_it_can,
                        device::SimulationMode default_mode = device::SimulationMode::fast);

/// What was typed, and the device if it had to be asked.
template <class Value>
struct Typed {
  Value value;
  std::optional<device::OpenArm> connection;
};

/// Reads what was typed by `read()`. A mistake in it is wrong usage, found before any device is touched; only a name
/// that no table has may be one of the device's own force law, so that the device is asked.
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

/// Name of the arm that --arm describes; empty without it, because a board does not know which arm it is built into.
std::string arm_name(const DeviceOptions& options);

}  // namespace inkwell::command_line
