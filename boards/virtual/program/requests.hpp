// Parses and checks requests of control socket clients. Each error message states the expected input.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>
#include "boards/stm32f405/core/interfaces.hpp"
#include "boards/stm32f405/peripherals/pin_name.hpp"
#include "boards/virtual/plant/hand.hpp"
#include "protocol/injection_request.hpp"

namespace inkwell::virtual_board {

/// Thrown for a refused command. what() is the error sentence for the client.
class Refused : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

enum class Command : std::uint8_t {
  status,
  truth,
  pause,
  stand_by,
  run,
  resume,
  reset,
  cut_power,
  quit,
  usb,
  buttons,
  supply,
  pin,
  glitch,
  inject,
  heal,
  hand,
  hand_path,
  gimbal,
  dock,
  meter,
  trace,
};

/// Name, keys and help text of a command. The parser, the checks and --help all use this data.
struct CommandInfo {
  Command command;
  std::string_view name;
  std::vector<std::string_view> keys;  ///< accepted keys except "command"
  std::string_view help;
  bool is_for_any_time = false;  ///< allowed in the middle of a bus frame
};
std::span<const CommandInfo> command_table();
/// Returns the help text with one line per command.
std::string explain_commands();

struct Request {
  const CommandInfo* info;
  nlohmann::json values;  ///< an object with known keys and unchecked values
};
/// Parses a command line of a client. read_request() and all functions below throw Refused.
Request read_request(std::string_view line);

bool truth_value(const nlohmann::json& request, const char* key);
double run_time_s(const nlohmann::json& request);
/// Returns the number of a flash operation. The power fails during this operation, or immediately for std::nullopt.
std::optional<std::uint64_t> flash_operation(const nlohmann::json& request);
double supply_voltage_V(const nlohmann::json& request);
double glitch_time_s(const nlohmann::json& request);
Vector3 gimbal_angles_rad(const nlohmann::json& request);
enum class MeterAction : std::uint8_t { start, read };
MeterAction meter_action(const nlohmann::json& request);
enum class TraceAction : std::uint8_t { start, stop, read };
TraceAction trace_action(const nlohmann::json& request);
/// Largest number of trace rows to read.
std::size_t trace_rows(const nlohmann::json& request);

struct HandRequest {
  bool holds = false;
  Vector3 target_m = Vector3::Zero();
  std::optional<double> stiffness_N_per_m = {};  ///< std::nullopt: unchanged
  std::optional<double> damping_Ns_per_m = {};   ///< std::nullopt: unchanged
};
HandRequest hand_request(const nlohmann::json& request);
std::vector<Waypoint> hand_path_request(const nlohmann::json& request);
std::array<bool, 2> pressed_buttons(const nlohmann::json& request);
PinName pin_of(const nlohmann::json& request);
/// Returns the level to drive at the pin, or std::nullopt for a read request.
std::optional<PinLevel> pin_drive(const nlohmann::json& request);
protocol::InjectionRequest injection_request(const nlohmann::json& request);

}  // namespace inkwell::virtual_board
