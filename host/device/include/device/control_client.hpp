// The control socket of a virtual board: the simulated hand, the inkwell, cables, time, and the truth
// that no real board could tell. One JSON object a line each way.
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

#include <device/error.hpp>
#include <device/socket_address.hpp>
#include <protocol/injection_request.hpp>

namespace inkwell::device {

using Vector3 = std::array<double, 3>;

/// What the simulated hand does: it pulls the probe to `target_m` (workspace frame) as a spring and a
/// damper would, or lets go.
struct Hand {
  bool holds = false;
  Vector3 target_m{};
  double stiffness_N_per_m = 300;
  double damping_Ns_per_m = 3;
};

/// The hand is at `target_m` `after_s` seconds of board time after the path was given.
struct HandWaypoint {
  double after_s = 0;
  Vector3 target_m{};
};

/// A fault that is in a virtual board, or still to come.
struct PutInFault {
  unsigned number;  ///< tells it from all others of this board
  std::string fault;
  std::string of;  ///< what it was put into; empty where there is one only
  std::optional<double> amount = {};
  double at_s;                         ///< board time at which it came, or will
  std::optional<double> until_s = {};  ///< none: until it is healed
  bool has_come;
  bool operator==(const PutInFault&) const = default;
};

/// What is in a virtual board at one instant.
struct Injections {
  double board_time_s = 0;
  /// The newest control period, counted from 0 since the last reset, and when it began. The firmware's `time_periods`
  /// is the same number, as long as its core was never kept from the control interrupt.
  std::uint64_t period = 0;
  double period_at_s = 0;
  std::vector<PutInFault> faults;  ///< those that are in, then those to come
};

/// A pin of the chip: "high", "low" or "floating".
struct PinLevels {
  std::string level;        ///< what a meter would show
  std::string chip_drives;  ///< what the chip itself puts out
};

/// What the hand got from the arm, and how hard the motors pressed, since the meter was started.
struct MeterReading {
  double peak_force_N = 0;
  double energy_J = 0;  ///< given to the hand; what it gave back is not taken off
  double travel_m = 0;  ///< the farthest from where it began
  double lag_m = 0;     ///< the farthest from where the hand pulls to
  /// That the torques of all motors together put on the probe, in the mean over a control period, while a bridge drove;
  /// not where the arm is singular.
  double peak_motor_force_N = 0;
  double peak_motor_force_over_ms_N = 0;  ///< the same in the mean over a millisecond
};

struct BoardStatus {
  double board_time_s = 0;
  std::string mode;
  bool paused = false;
  std::string locked_up;                ///< why the processor is, and board time stands still; empty if it is not
  std::vector<std::string> unmodelled;  ///< accesses to registers that the virtual chip does not model
  nlohmann::json all;                   ///< the whole reply

  /// For who waits for the firmware: throws Error with a sentence if it never will do anything.
  void insist_on_running() const;
};

/// Rows of the true quantities, one for each control period; values[row * columns.size() + column].
struct Trace {
  std::vector<std::string> columns;
  std::vector<double> values;
  std::size_t row_count() const { return columns.empty() ? 0 : values.size() / columns.size(); }
};

/// The board does not do what was asked for; the connection is as good as before.
class CommandRefused : public Error {
 public:
  using Error::Error;
};

/// Not for use by two threads at once: make one client for each. Every call throws CommandRefused if the board
/// refuses it, and Disconnected if the board is gone.
class ControlClient {
 public:
  explicit ControlClient(const SocketAddress& server);
  ~ControlClient();
  ControlClient(ControlClient&&) noexcept;
  ControlClient& operator=(ControlClient&&) noexcept;

  /// An answer that takes longer is an Error, after which this client is of no more use. For ever unless said.
  void wait_at_most(std::chrono::milliseconds limit);

  BoardStatus status();
  nlohmann::json truth();

  void pause();     ///< board time stands still
  void stand_by();  ///< it stands still, but passes while a USB control transfer is under way
  /// Lets `for_s` of board time pass; it then stands still again, or stands by if it did before. When this returns, the
  /// device's link has everything that the device sent.
  void run(double for_s);
  void resume();
  void reset();      ///< by its pin
  void cut_power();  ///< it goes and comes at once; the memory is not cleared
  void quit();

  void usb(bool connected);
  void buttons(bool first, bool second);
  void supply(double voltage_V);
  PinLevels pin(const std::string& pin);  ///< such as "PA0"
  /// The same after it is driven from outside: "high", "low" or "floating".
  PinLevels drive_pin(const std::string& pin, const std::string& level);
  void glitch(const std::string& pin, double duration_s);  ///< a pin ("PA0") is the opposite of what drives it
  /// Puts a fault in, and says when it comes.
  PutInFault inject(const protocol::InjectionRequest& fault);
  void heal(const std::string& fault, const std::string& of = {});  ///< takes it out, anywhere if no place is named
  void heal_all();
  Injections injections();
  void hand(const Hand& hand);
  void hand_path(const std::vector<HandWaypoint>& path);  ///< minimum jerk between the waypoints
  void gimbal(const Vector3& angles_rad);                 ///< turns the stylus: yaw, pitch, roll
  void dock(bool docked);                                 ///< presses the stylus into the inkwell, or takes it out

  void meter_start();  ///< measures what the hand gets from the arm, from now on
  MeterReading meter_read();

  void trace_start();
  void trace_stop();
  Trace trace_read(std::size_t rows_maximum);  ///< the oldest rows not read yet; no rows when there are none

 private:
  nlohmann::json call(const nlohmann::json& request);
  PinLevels call_pin(const nlohmann::json& request);
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace inkwell::device
