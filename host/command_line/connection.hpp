// The options that say which device is meant, and the way to it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include <device/device.hpp>
#include <device/virtual_board.hpp>

namespace inkwell::command_line {

/// A mistake in what was typed; the program ends with exit code 2.
class UsageError : public device::Error {
 public:
  using Error::Error;
};

/// How a virtual board's time passes, unless --real-time was given.
enum class BoardTime : std::uint8_t {
  as_it_can,
  paced,     ///< to the clock on the wall
  as_asked,  ///< stands still from its first instruction on, but while Connection::control lets it pass
};

struct DeviceOptions {
  bool is_virtual = false;
  std::filesystem::path elf;
  std::filesystem::path arm;
  std::string mode;  ///< empty: the command's own choice
  std::uint64_t seed = 1;
  bool real_time = false;
  std::string usbip;  ///< HOST:PORT
  std::string serial_number;
  bool json = false;
  bool is_strict = false;  ///< a virtual board ends when the firmware does what silicon would not bear

  void add_to(CLI::App& app);
  device::VirtualBoardOptions virtual_board(device::SimulationMode default_mode, BoardTime time) const;
};

/// What was found where the options point, without waiting.
std::vector<device::Endpoint> list_devices(const DeviceOptions& options, const device::VirtualBoard* board);

/// An open device and, with --virtual, the board that it is on.
struct Connection {
  std::unique_ptr<device::VirtualBoard> board;
  std::optional<device::ControlClient> control;  ///< of a board whose time passes as asked
  std::unique_ptr<device::Device> device;
  bool is_simulation = false;
};

/// Opens the device that the options name. With --arm, a virtual board's firmware gets that arm's parameters.
Connection connect(const DeviceOptions& options, BoardTime time = BoardTime::as_it_can,
                   device::SimulationMode default_mode = device::SimulationMode::fast);

/// The endpoint of a real device, or of one at --usbip. Throws device::Error if there is none.
device::Endpoint find_one(const DeviceOptions& options);

/// Name of the arm that --arm describes; empty without it, because a board does not know which arm it is built into.
std::string arm_name(const DeviceOptions& options);

/// The rows of the parameter table that an arm description sets.
std::vector<device::ParameterChange> arm_parameters(const std::filesystem::path& file);

}  // namespace inkwell::command_line
