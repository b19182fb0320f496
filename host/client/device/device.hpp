// Device implements the protocol on top of a transport. All calls are synchronous. session.hpp contains a client with
// threads.
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "host/client/device/force_law.hpp"
#include "host/client/device/program_force.hpp"
#include "host/client/device/scope_decoder.hpp"
#include "host/client/device/transport.hpp"
#include "host/client/device/wide_reports.hpp"
#include "protocol/black_box.hpp"
#include "protocol/driver.hpp"
#include "protocol/reports.hpp"
#include "protocol/self_test.hpp"
#include "protocol/store.hpp"

namespace inkwell::device {

struct Information {
  std::string firmware_version;
  std::uint16_t protocol_version;
  std::string serial_number;
  std::string board_name;  ///< board name from the device; empty: not reported
  protocol::InformationReport report;
  std::shared_ptr<const ForceLaw> force_law;  ///< force law of the firmware image; null until a device has reported it
};

class Incompatible : public Error {
 public:
  explicit Incompatible(const std::string& sentence, std::string board = {})
      : Error(sentence), board_name(std::move(board)) {}
  std::string board_name;  ///< empty: not reported
};

/// The board refused a transaction; all parameters keep their old values.
class Refused : public Error {
 public:
  explicit Refused(const protocol::TransactionReport& refusal);
  protocol::TransactionReport report;
};

class NotTested : public Error {
 public:
  using Error::Error;
};

struct Driver {
  std::string program;       ///< program name, printable ASCII
  std::uint32_t process_id;  ///< process number on the computer of the program
  double driven_s;           ///< board time since the program claimed the arm
  /// Number of the Device object that drives the arm, counted from 1 in opening order. Without a value, another process
  /// drives the arm.
  std::optional<int> object;
  bool is_this_device;
};

/// Returns a text such as "python3 (process 123), which claimed it 12 s ago".
std::string driver_text(const Driver& driver);

using ParameterChange = std::pair<protocol::Parameter, float>;

/// Several threads may use a Device. Only one thread may read poses, and only one thread may read the scope.
class Device {
 public:
  /// Opens the device and checks the protocol version. Throws Incompatible with the remedy if the versions differ. Adds
  /// the device's force law to the tables of this program. Throws Error if the tables contain another force law.
  static std::unique_ptr<Device> open(const Endpoint& endpoint);
  explicit Device(std::unique_ptr<Transport> transport);
  ~Device();

  /// Replaces the link of this device by the link of `opened`, which must belong to the same board. Do not use `opened`
  /// afterwards. References to this device stay valid. Calls on the old link may fail. Throws Error if the board has
  /// another force law.
  void take_link_of(Device& opened);

  /// If the protocol version differs, only the members before the table hashes are valid. The other members are 0.
  Information information();
  /// Returns the start of the newest bus frame, or std::nullopt while no bus frames arrive.
  std::optional<BusFrame> bus_frame();

  /// Continues the 64-bit board time of an earlier connection, unless the board has restarted. `before_periods` is the
  /// time of the newest pose of that connection.
  void continue_time(std::int64_t before_periods);

  /// Waits for the next pose report. Returns std::nullopt after a time-out.
  std::optional<Pose> read_pose(std::chrono::milliseconds timeout);

  /// Returns the program that drives the arm, or std::nullopt if no program drives it.
  std::optional<Driver> driver();
  /// Sets `driver` to the current driver. Returns false without waiting if another thread has a request in progress.
  bool try_driver(std::optional<Driver>& driver);
  /// Makes this object the driver of the arm. The claim expires after protocol::claim_expiry_s without a sign of life.
  /// Throws InUse with the driver's name if another object or program drives the arm. If the driver's process has
  /// exited on this computer, the call waits until its claim expires.
  void claim();
  /// Claims the arm even if another program drives it. The force of the other program fades out.
  void take_over();
  /// Releases the claim and removes shapes and force. Has no effect if this object does not drive the arm. Has no
  /// effect in a forked child, because the parent owns the claim.
  void release();
  /// Discards the claim without a message to the board.
  void abandon();
  /// Returns true while this object drives the arm. read_pose() updates this value.
  bool drives() const;

  /// Sends a command and waits until the control interrupt has executed it. A command that the current state does not
  /// allow has no effect and is not an error. Throws InUse if another program drives the arm. Throws Error if the board
  /// does not execute the command in time.
  void carry_out(protocol::Command command);
  void carry_out(protocol::Command command, const protocol::TestPulse& pulse);
  /// Both functions switch the force off and wait until the force is off. stop() switches immediately, even if another
  /// program drives the arm. disable_force() fades the force out and throws InUse if another program drives the arm.
  void stop();
  void disable_force();
  /// Calls disable_force() or, if another program drives the arm, stop().
  void switch_force_off();

  /// Sends a command without waiting for its result. Returns the token that PoseReport::command_token later repeats.
  std::uint8_t send(protocol::Command command);
  /// Call this after each pose that was read. Sends a heartbeat if 10 ms of board time have passed since the last
  /// output report.
  void keep_alive();
  std::uint8_t send(protocol::Command command, const protocol::TestPulse& pulse);
  /// Selects the signals of the scope. An empty selection stops the scope and releases it for other programs. Throws
  /// InUse if another program uses the scope.
  std::uint8_t select_signals(std::span<const protocol::Signal> signals);

  /// Waits until the board has received all sent commands and forces. Returns false after a time-out. The next force is
  /// then sent without delay.
  bool wait_until_written(std::chrono::milliseconds timeout);
  /// Sets the force until the next request or until its expiry. Each request is a sign of life. Throws Error if a value
  /// is not allowed.
  void send_force(const ForceRequest& request);
  /// Replaces the local model and sets the force, both in one report. Throws Error if a value is not allowed.
  void send_local_model(const LocalModel& model, const ForceRequest& force);
  /// Replaces all shapes within one control period. Throws Error if a value is not allowed or the board stays busy.
  /// Throws InUse if this object does not drive the arm.
  void place_shapes(const Shapes& shapes);

  protocol::ParameterSet parameters();
  /// Changes the parameters in one transaction, which takes effect in one control period. Throws Refused, without any
  /// change, if the board refuses a value.
  AcceptedTransaction set_parameters(std::span<const ParameterChange> changes);
  AcceptedTransaction restore_default_parameters();
  /// Sets every parameter to its stored value. Throws Refused if the board has no stored parameters.
  AcceptedTransaction restore_stored_parameters();
  /// Returns the parameter values after the next start, which are the stored values or the defaults.
  protocol::ParameterSet stored_parameters();
  /// Returns the state of the stored parameters.
  protocol::StoreReport store_report();

  /// Returns the black box of the last fault. Its `fault` is none if the black box is empty. Its 32-bit counters start
  /// at the last board start before the fault.
  protocol::BlackBoxReport black_box();
  /// Returns the rows of `box` in chronological order. Throws Error if the board has discarded this black box.
  std::vector<protocol::BlackBoxRow> black_box_rows(const protocol::BlackBoxReport& box);

  /// Returns the newest result of each self-test item.
  protocol::SelfTestReport read_self_test();
  /// Runs the self-test, which lasts 0.05 s, and returns the results. Throws NotTested while the force is on or a fault
  /// is active.
  protocol::SelfTestReport self_test();

  /// Waits for the next scope frame. Returns std::nullopt after a time-out.
  std::optional<ScopeSamples> read_scope(std::chrono::milliseconds timeout);
  std::uint64_t malformed_scope_frames() const;

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace inkwell::device
