// Connects to the control socket of a virtual board. Each request and each answer is one JSON object on one line.
#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "host/client/device/error.hpp"
#include "host/client/device/socket_address.hpp"
#include "protocol/injection_request.hpp"

namespace inkwell::device {

using Vector3 = std::array<double, 3>;

/// The simulated hand. While `holds` is true, a spring and a damper pull the probe to `target_m` in the workspace.
struct Hand {
  bool holds = false;
  Vector3 target_m{};
  double stiffness_N_per_m = 300;
  double damping_Ns_per_m = 3;
};

/// A target position, which the hand reaches `after_s` seconds of board time after the previous target.
struct HandWaypoint {
  double after_s = 0;
  Vector3 target_m{};
};

/// An injected fault of a virtual board, active or scheduled.
struct Injection {
  unsigned number;  ///< unique within this board
  std::string fault;
  std::string of;  ///< the affected component, or empty if there is only one
  std::optional<double> amount = {};
  double at_s;                         ///< board time when the fault starts
  std::optional<double> until_s = {};  ///< board time when the fault ends; empty: no end
  bool has_come;
  bool operator==(const Injection&) const = default;
};

/// The injected faults of a virtual board at one instant.
struct Injections {
  double board_time_s = 0;
  /// The newest control period since the last reset, counted from 0. The period equals the firmware's `time_periods`
  /// unless the core has missed a control interrupt.
  std::uint64_t period = 0;
  double period_at_s = 0;
  std::vector<Injection> faults;  ///< active faults, then scheduled faults
};

/// The level of a pin is "high", "low" or "floating".
struct PinLevels {
  std::string level;        ///< measured at the pin
  std::string chip_drives;  ///< output driver of the chip
};

/// Force and motion of the hand since meter_start().
struct MeterReading {
  double peak_force_N = 0;
  double energy_J = 0;  ///< energy delivered to the hand, not reduced by energy from the hand
  double travel_m = 0;  ///< largest distance from the start position
  double lag_m = 0;     ///< largest distance from the hand's target
  /// The torques of all motors determine this force on the probe, averaged over a control period. It is measured only
  /// while a bridge drives and the arm is not singular.
  double peak_motor_force_N = 0;
  double peak_motor_force_over_ms_N = 0;  ///< the same force, averaged over a millisecond
};

struct BoardStatus {
  double board_time_s = 0;
  std::string mode;
  bool paused = false;
  std::string locked_up;                ///< reason for a processor lock-up, or empty
  std::vector<std::string> unmodelled;  ///< register accesses that the virtual chip does not model
  nlohmann::json all;                   ///< the whole reply

  /// Throws Error if the processor is locked up.
  void insist_on_running() const;
};

/// Rows of true values, one row per control period. The value of a column is values[row * columns.size() + column].
struct Trace {
  std::vector<std::string> columns;
  std::vector<double> values;
  std::size_t row_count() const { return columns.empty() ? 0 : values.size() / columns.size(); }
};

/// The board refuses the command; the connection remains usable.
class CommandRefused : public Error {
 public:
  using Error::Error;
};

/// Each thread needs a separate client. Each call throws CommandRefused if the board refuses the command, and
/// Disconnected if the connection is lost.
class ControlClient {
 public:
  explicit ControlClient(const SocketAddress& server);
  ~ControlClient();
  ControlClient(ControlClient&&) noexcept;
  ControlClient& operator=(ControlClient&&) noexcept;

  /// Limits the waiting time for an answer. A time-out throws Error and makes the client unusable. By default there is
  /// no limit.
  void wait_at_most(std::chrono::milliseconds limit);

  BoardStatus status();
  nlohmann::json truth();

  void pause();     ///< stops board time
  void stand_by();  ///< stops board time, except during a USB control transfer
  /// Advances board time by `for_s`, then returns to the pause or standby state. All data that the device sent have
  /// then reached the host.
  void run(double for_s);
  void resume();
  void reset();      ///< resets the chip through its reset pin
  void cut_power();  ///< interrupts the power briefly without clearing the memory
  void quit();

  void usb(bool connected);
  void buttons(bool first, bool second);
  void supply(double voltage_V);
  PinLevels pin(const std::string& pin);  ///< such as "PA0"
  PinLevels drive_pin(const std::string& pin, const std::string& level);
  void glitch(const std::string& pin, double duration_s);  ///< inverts a pin ("PA0") for `duration_s`
  /// Injects a fault and returns its number and start time.
  Injection inject(const protocol::InjectionRequest& injection);
  void heal(const std::string& fault, const std::string& of = {});  ///< from `of`, or from all
  void heal_all();
  Injections injections();
  void hand(const Hand& hand);
  void hand_path(const std::vector<HandWaypoint>& path);  ///< moves with minimum jerk between the waypoints
  void gimbal(const Vector3& angles_rad);                 ///< turns the stylus to these yaw, pitch and roll angles
  void dock(bool docked);  ///< presses the stylus into the inkwell, or removes the stylus

  void meter_start();  ///< starts the measurement for MeterReading
  MeterReading meter_read();

  void trace_start();
  void trace_stop();
  Trace trace_read(std::size_t rows_maximum);  ///< returns the oldest unread rows, or no rows if all were read

 private:
  nlohmann::json call(const nlohmann::json& request);
  PinLevels call_pin(const nlohmann::json& request);
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace inkwell::device
