// The protocol on top of a transport: poses, commands, forces, parameters, scope. Synchronous; see session.hpp for the
// threaded client that the window uses.
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <device/force_law.hpp>
#include <device/program_force.hpp>
#include <device/scope_decoder.hpp>
#include <device/transport.hpp>
#include <protocol/black_box.hpp>
#include <protocol/reports.hpp>
#include <protocol/self_test.hpp>
#include <protocol/store.hpp>

namespace inkwell::device {

struct Information {
  std::string firmware_version;
  std::uint16_t protocol_version;
  std::string serial_number;
  std::string board_name;  ///< empty: it tells none. The device's word, which need not be a board that is known here
  protocol::InformationReport report;
  std::shared_ptr<const ForceLaw> force_law;  ///< of its image; null only where no device told it
};

/// The device speaks another version of the protocol than this program.
class Incompatible : public Error {
 public:
  explicit Incompatible(const std::string& sentence, std::string board = {})
      : Error(sentence), board_name(std::move(board)) {}
  std::string board_name;  ///< empty: it tells none
};

/// A transaction was refused; the device keeps its old values.
class Refused : public Error {
 public:
  explicit Refused(const protocol::TransactionReport& refusal);
  protocol::TransactionReport report;
};

/// The board does not test itself now. `what()` says why.
class NotTested : public Error {
 public:
  using Error::Error;
};

using ParameterChange = std::pair<protocol::Parameter, float>;

/// May be used by several threads, but poses are read by one of them and the scope by one.
class Device {
 public:
  /// Opens the device and checks the protocol version first. Throws Error with the remedy if it differs. The rows of
  /// its force law join the tables; if those of another law are there already, it throws Error as well.
  static std::unique_ptr<Device> open(const Endpoint& endpoint);
  explicit Device(std::unique_ptr<Transport> transport);
  ~Device();

  /// Of a device of another version only what comes before the tables' hashes; the rest is 0.
  Information information();
  /// When the newest frame of the bus began. Throws Stalled while the bus is silent.
  protocol::FrameReport frame();

  /// Waits for the next pose report; none on time-out.
  std::optional<protocol::PoseReport> read_pose(std::chrono::milliseconds timeout);

  /// Sends a command and returns its token, which comes back in PoseReport::command_token.
  std::uint8_t send(protocol::Command command);
  /// Sends a heartbeat unless a command went out in the last 10 ms of wall time and, as far as the poses read
  /// tell, of board time (a virtual board may run faster than the clock); none while board time stands still.
  /// Belongs in the loop that reads poses.
  void keep_alive();
  std::uint8_t send(protocol::Command command, const protocol::TestPulse& pulse);
  /// None stops the scope, and another program may have it. Throws InUse if another program has it.
  std::uint8_t select_signals(std::span<const protocol::Signal> signals);

  /// The force from now on, until the next one or its expiry. A sign of life. Throws Error for one that the board would
  /// refuse.
  void send_force(const ForceRequest& request);
  /// Takes the place of all shapes that were there, at one control period. Throws likewise.
  void place_shapes(const Shapes& shapes);

  protocol::ParameterSet parameters();
  /// One transaction: all take effect at one control period, or none does and Refused is thrown.
  protocol::TransactionReport set_parameters(std::span<const ParameterChange> changes);
  protocol::TransactionReport restore_default_parameters();
  /// Each gets what the board's next start would give it. Throws Refused if the board has stored nothing.
  protocol::TransactionReport restore_stored_parameters();
  /// What the board's next start would give each parameter: what it has stored, or the default.
  protocol::ParameterSet stored_parameters();
  /// What the board has stored. The commands that change it are in board_store.hpp.
  protocol::StoreReport store_report();

  /// What the board kept of the time around its last fault; its `fault` is none if it keeps nothing.
  protocol::BlackBoxReport black_box();
  /// The rows of this one, in the order of time. Throws Error if the board gave it up meanwhile.
  std::vector<protocol::BlackBoxRow> black_box_rows(const protocol::BlackBoxReport& box);

  /// The newest result of each item of the board's self-test.
  protocol::SelfTestReport read_self_test();
  /// Lets the board test itself, which takes a twentieth of a second, and returns what it found. Throws NotTested if
  /// the board does not: the force is on, or a fault is shown.
  protocol::SelfTestReport self_test();

  /// Waits for the next scope frame; none on time-out.
  std::optional<ScopeSamples> read_scope(std::chrono::milliseconds timeout);
  std::uint64_t malformed_scope_frames() const;

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace inkwell::device
