// The control socket of a virtual board: simulated hand, inkwell, cables, time, and the true values of the simulation.
// Each request and each answer is one JSON object on one line.
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

/// The simulated hand. While the hand holds the stylus, a spring and a damper pull the probe to `target_m` (workspace
/// frame).
struct Hand {
  bool holds = false;
  Vector3 target_m{};
  double stiffness_N_per_m = 300;
  double damping_Ns_per_m = 3;
};

/// Target of the hand, and board time until the hand reaches the target.
struct HandWaypoint {
  double after_s = 0;
  Vector3 target_m{};
};

/// An injected fault of a virtual board, active or scheduled.
struct Injection {
  unsigned number;  ///< unique within this board
  std::string fault;
  std::string of;  ///< the affected component; empty if there is only one
  std::optional<double> amount = {};
  double at_s;                         ///< board time of its start
  std::optional<double> until_s = {};  ///< none: until it is removed
  bool has_come;
  bool operator==(const Injection&) const = default;
};

/// The injected faults of a virtual board at one instant.
struct Injections {
  double board_time_s = 0;
  /// The newest control period, counted from 0 since the last reset, and its board time. The period equals the
  /// firmware's `time_periods` unless the core missed a control interrupt.
  std::uint64_t period = 0;
  double period_at_s = 0;
  std::vector<Injection> faults;  ///< active faults, then scheduled faults
};

/// A pin of the chip: "high", "low" or "floating".
struct PinLevels {
  std::string level;        ///< the level that a meter would show
  std::string chip_drives;  ///< the output of the chip itself
};

/// Energy and motion of the hand, and peak motor force, since the meter was started.
struct MeterReading {
  double peak_force_N = 0;
  double energy_J = 0;  ///< energy delivered to the hand; energy from the hand is not subtracted
  double travel_m = 0;  ///< largest distance from the start position
  double lag_m = 0;     ///< largest distance from the hand's target
  /// Force on the probe from the torques of all motors, averaged over a control period. The force is measured only
  /// while a bridge drives and the arm is not singular.
  double peak_motor_force_N = 0;
  double peak_motor_force_over_ms_N = 0;  ///< the same, averaged over a millisecond
};

struct BoardStatus {
  double board_time_s = 0;
  std::string mode;
  bool paused = false;
  std::string locked_up;                ///< reason why the processor is locked up and board time is stopped; otherwise
                                        ///< empty
  std::vector<std::string> unmodelled;  ///< accesses to registers that the virtual chip does not model
  nlohmann::json all;                   ///< the whole reply

  /// Throws Error if the firmware cannot continue. Callers that wait for the firmware use this function.
  void insist_on_running() const;
};

/// Rows of true values, one per control period; values[row * columns.size() + column].
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

/// Each thread needs a separate client. Every call throws CommandRefused if the board refuses the command, and
/// Disconnected if the board is gone.
class ControlClient {
 public:
  explicit ControlClient(const SocketAddress& server);
  ~ControlClient();
  ControlClient(ControlClient&&) noexcept;
  ControlClient& operator=(ControlClient&&) noexcept;

  /// Limits the wait for an answer. A time-out throws Error and makes the client unusable. The default is no limit.
  void wait_at_most(std::chrono::milliseconds limit);

  BoardStatus status();
  nlohmann::json truth();

  void pause();     ///< stops board time
  void stand_by();  ///< stops board time, except during a USB control transfer
  /// Lets `for_s` of board time pass and then returns to the pause or standby state. When run() returns, the host's
  /// link has received everything that the device sent.
  void run(double for_s);
  void resume();
  void reset();      ///< through the reset pin
  void cut_power();  ///< a short power interruption; the memory is not cleared
  void quit();

  void usb(bool connected);
  void buttons(bool first, bool second);
  void supply(double voltage_V);
  PinLevels pin(const std::string& pin);  ///< such as "PA0"
  /// Drives the pin externally ("high", "low" or "floating") and returns its levels.
  PinLevels drive_pin(const std::string& pin, const std::string& level);
  void glitch(const std::string& pin, double duration_s);  ///< inverts a pin ("PA0") for this time
  /// Injects a fault and returns its number and start time.
  Injection inject(const protocol::InjectionRequest& injection);
  void heal(const std::string& fault, const std::string& of = {});  ///< removes the fault; without `of`, from all
                                                                    ///< components
  void heal_all();
  Injections injections();
  void hand(const Hand& hand);
  void hand_path(const std::vector<HandWaypoint>& path);  ///< minimum jerk between the waypoints
  void gimbal(const Vector3& angles_rad);                 ///< turns the stylus: yaw, pitch, roll
  void dock(bool docked);                                 ///< presses the stylus into the inkwell, or removes it

  void meter_start();  ///< starts the measurement of force and energy at the hand
  MeterReading meter_read();

  void trace_start();
  void trace_stop();
  Trace trace_read(std::size_t rows_maximum);  ///< the oldest unread rows; no rows if all were read

 private:
  nlohmann::json call(const nlohmann::json& request);
  PinLevels call_pin(const nlohmann::json& request);
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace inkwell::device
