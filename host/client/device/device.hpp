// The protocol on top of a transport: poses, commands, forces, parameters, scope. All calls are synchronous. The
// threaded client of the window is in session.hpp.
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
  std::string board_name;  ///< as the device reports it, possibly unknown to this program; empty: not reported
  protocol::InformationReport report;
  std::shared_ptr<const ForceLaw> force_law;  ///< of the firmware image; null only if no device has reported it
};

/// The device uses another protocol version than this program.
class Incompatible : public Error {
 public:
  explicit Incompatible(const std::string& sentence, std::string board = {})
      : Error(sentence), board_name(std::move(board)) {}
  std::string board_name;  ///< empty: not reported
};

/// A transaction was refused; the device retains its old values.
class Refused : public Error {
 public:
  explicit Refused(const protocol::TransactionReport& refusal);
  protocol::TransactionReport report;
};

/// The board cannot run its self-test now. `what()` states the reason.
class NotTested : public Error {
 public:
  using Error::Error;
};

/// The program that drives an arm.
struct Driver {
  std::string program;       ///< program name, printable ASCII
  std::uint32_t process_id;  ///< on the computer of the program
  double driven_s;           ///< board time since it claimed the arm
  /// Number of the driving object, from 1 in opening order; none if another process holds the claim.
  std::optional<int> object;
  bool is_this_device;  ///< true if `object` is this device
};

/// "python3 (process 123), which claimed it 12 s ago" or "this program itself, ...".
std::string driver_text(const Driver& driver);

using ParameterChange = std::pair<protocol::Parameter, float>;

/// Several threads may use a device. Only one thread may read poses, and only one may read the scope.
class Device {
 public:
  /// Opens the device and checks the protocol version first. Throws Error with the remedy if the version differs. Adds
  /// the rows of the device's force law to the tables. Throws Error if the tables contain another force law.
  static std::unique_ptr<Device> open(const Endpoint& endpoint);
  explicit Device(std::unique_ptr<Transport> transport);
  ~Device();

  /// Continues on the link of `opened`, which must be a device on the same board. Do not use `opened` afterwards.
  /// References to this device stay valid. Calls that wait on the old link fail when that link fails. Throws Error if
  /// the board has another force law.
  void take_link_of(Device& opened);

  /// For a device of another protocol version, only the members before the table hashes are valid; the rest is 0.
  Information information();
  /// The start of the newest bus frame; none while no bus frames arrive.
  std::optional<BusFrame> bus_frame();

  /// Continues the board time of an earlier connection whose newest pose was at `before_periods`, unless the board has
  /// restarted since then.
  void continue_time(std::int64_t before_periods);

  /// Waits for the next pose report; none on time-out.
  std::optional<Pose> read_pose(std::chrono::milliseconds timeout);

  /// Returns the program that drives the arm, or none if no program drives it.
  std::optional<Driver> driver();
  /// Writes the driver into `driver`. Returns false without waiting if another thread has a request in progress,
  /// because in lock step that thread may wait for the next pose.
  bool try_driver(std::optional<Driver>& driver);
  /// Makes this object the driver until release(), until its destruction, or until protocol::claim_expiry_s have passed
  /// without a sign of life. Throws InUse with the driver's name if another object or program drives the arm. If the
  /// process of the driver does not exist on this computer, claim() first waits until the claim of the driver expires.
  void claim();
  /// Like claim(), but ends the claim of the current driver, whose force fades out.
  void take_over();
  /// Ends the claim, which removes the shapes and the force. Has no effect if this object does not drive the arm. Has
  /// no effect in a forked child, because the claim belongs to the parent.
  void release();
  /// Drops the claim without informing the board, like a killed program.
  void abandon();
  /// Whether this object drives the arm. read_pose() detects the loss of the claim.
  bool drives() const;

  /// Sends a command and returns once the control interrupt has executed it. A command that the current state does not
  /// allow has no effect and is not an error. Throws InUse if another program drives the arm, and Error if the board
  /// does not execute the command in time.
  void carry_out(protocol::Command command);
  void carry_out(protocol::Command command, const protocol::TestPulse& pulse);
  /// `stop()` and `disable_force()` switch the force off and return when the force is off. stop() acts immediately,
  /// also if another program drives the arm. disable_force() fades the force out, and throws InUse if another program
  /// drives the arm.
  void stop();
  void disable_force();
  /// Calls disable_force(), or stop() if another program drives the arm.
  void switch_force_off();

  /// Sends a command and returns its token, which PoseReport::command_token repeats. The result of the command is not
  /// known on return.
  std::uint8_t send(protocol::Command command);
  /// Sends a heartbeat if, according to the poses read, 10 ms of board time have passed since the last output report.
  /// Call this in the loop that reads poses.
  void keep_alive();
  std::uint8_t send(protocol::Command command, const protocol::TestPulse& pulse);
  /// Selects the signals of the scope. An empty selection stops the scope and makes it available to other programs.
  /// Throws InUse if another program uses the scope.
  std::uint8_t select_signals(std::span<const protocol::Signal> signals);

  /// Waits until the board has received every command and force that was sent; false on time-out. A force that is sent
  /// afterwards is not queued and arrives in the next bus frame.
  bool wait_until_written(std::chrono::milliseconds timeout);
  /// Sets the force until the next request or its expiry. Every request is a sign of life. Throws Error if the board
  /// would refuse the request.
  void send_force(const ForceRequest& request);
  /// Replaces all shapes within one control period. Throws Error if the board would refuse the shapes or stays busy,
  /// and InUse if this object does not drive the arm.
  void place_shapes(const Shapes& shapes);

  protocol::ParameterSet parameters();
  /// One transaction, in which all changes take effect in the same control period. Throws Refused if the board refuses
  /// a change; then no parameter changes.
  AcceptedTransaction set_parameters(std::span<const ParameterChange> changes);
  AcceptedTransaction restore_default_parameters();
  /// Sets every parameter to its stored value. Throws Refused if the board has no stored parameters.
  AcceptedTransaction restore_stored_parameters();
  /// The parameter values after the next start: the stored values, or the defaults.
  protocol::ParameterSet stored_parameters();
  /// The state of the stored parameters. The commands that change the stored parameters are in board_store.hpp.
  protocol::StoreReport store_report();

  /// The black box of the last fault; its `fault` is none if the black box is empty. All counters start at the last
  /// board start before the fault, and have 32 bits.
  protocol::BlackBoxReport black_box();
  /// The rows of this black box in chronological order. Throws Error if the board has discarded this black box.
  std::vector<protocol::BlackBoxRow> black_box_rows(const protocol::BlackBoxReport& box);

  /// The newest result of each self-test item.
  protocol::SelfTestReport read_self_test();
  /// Runs the self-test, which takes 0.05 s, and returns the results. Throws NotTested if the board refuses because the
  /// force is on or a fault is active.
  protocol::SelfTestReport self_test();

  /// Waits for the next scope frame; none on time-out.
  std::optional<ScopeSamples> read_scope(std::chrono::milliseconds timeout);
  std::uint64_t malformed_scope_frames() const;

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace inkwell::device
