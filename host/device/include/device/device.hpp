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
#include <device/wide_reports.hpp>
#include <protocol/black_box.hpp>
#include <protocol/driver.hpp>
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

/// The program that drives an arm.
struct Driver {
  std::string program;       ///< its name, printable ASCII
  std::uint32_t process_id;  ///< on its computer
  double driven_s;           ///< board time since it claimed the arm
  /// The object of this process that holds the claim, counted from 1 in the order of opening; none for another process.
  std::optional<int> object;
  bool is_this_device;  ///< that object is this one
};

/// "python3 (process 123), which claimed it 12 s ago" or "this program itself, ...".
std::string driver_text(const Driver& driver);

using ParameterChange = std::pair<protocol::Parameter, float>;

/// May be used by several threads, but poses are read by one of them and the scope by one.
class Device {
 public:
  /// Opens the device and checks the protocol version first. Throws Error with the remedy if it differs. The rows of
  /// its force law join the tables; if those of another law are there already, it throws Error as well.
  static std::unique_ptr<Device> open(const Endpoint& endpoint);
  explicit Device(std::unique_ptr<Transport> transport);
  ~Device();

  /// Continues on the link of `opened`, which was opened for the same board and is not used afterwards. References to
  /// this device stay valid. Calls that wait on the old link fail when that link fails. Throws Error if the board has
  /// another force law.
  void take_link_of(Device& opened);

  /// Of a device of another version only what comes before the tables' hashes; the rest is 0.
  Information information();
  /// The start of the newest bus frame; none while the bus is silent.
  std::optional<BusFrame> frame();

  /// The device was connected before, when its newest pose was of `before_periods`: its time goes on from there, unless
  /// it has started again since then.
  void continue_time(std::int64_t before_periods);

  /// Waits for the next pose report; none on time-out.
  std::optional<Pose> read_pose(std::chrono::milliseconds timeout);

  /// The program that drives the arm; none if no program does.
  std::optional<Driver> driver();
  /// The same, put into `driver`. False, without waiting, if another thread has a request under way: in lock step that
  /// thread waits for the next pose.
  bool try_driver(std::optional<Driver>& driver);
  /// This object drives the arm from now on, until release() or its end, or until the board has heard nothing from it
  /// for protocol::claim_expiry_s. Throws InUse, naming the driver, if another object or program drives the arm. If no
  /// such process is on this computer, it was probably killed: then its claim is waited for to end.
  void claim();
  /// Like claim(), but it ends the claim of the current driver. The force of that program fades.
  void take_over();
  /// Ends the claim, and with it shapes and force. Without effect if this object does not drive, and in a forked child,
  /// whose copy of the claim is its parent's.
  void release();
  /// Forgets the claim without a word to the board, as a program that is killed.
  void abandon();
  /// Whether this object drives the arm. read_pose() notices when the claim has been lost.
  bool drives() const;

  /// Sends a command, and returns once the control interrupt has carried it out. That says nothing of its effect: a
  /// command that does not fit the state has none. Throws InUse if another program drives the arm, and Error if the
  /// board does not carry it out in time.
  void carry_out(protocol::Command command);
  void carry_out(protocol::Command command, const protocol::TestPulse& pulse);
  /// Switches the force off, and returns once it is off. stop() does so at once, whichever program drives the arm;
  /// disable_force() lets it fall softly, and throws InUse if another program drives the arm.
  void stop();
  void disable_force();
  /// disable_force(), or stop() if another program drives the arm.
  void switch_force_off();

  /// Sends a command and returns its token, which comes back in PoseReport::command_token. Whether the board accepts it
  /// is not known yet.
  std::uint8_t send(protocol::Command command);
  /// Sends a heartbeat if the poses read show that 10 ms of board time have passed since the last output report.
  /// Belongs in the loop that reads poses.
  void keep_alive();
  std::uint8_t send(protocol::Command command, const protocol::TestPulse& pulse);
  /// None stops the scope, and another program may have it. Throws InUse if another program has it.
  std::uint8_t select_signals(std::span<const protocol::Signal> signals);

  /// Waits until the board has every command and force that was sent; false on time-out. A force that is sent then
  /// arrives in the next frame of the bus, and not behind others.
  bool wait_until_written(std::chrono::milliseconds timeout);
  /// The force from now on, until the next one or its expiry. A sign of life. Throws Error for one that the board would
  /// refuse.
  void send_force(const ForceRequest& request);
  /// Replaces all shapes within one control period. Throws Error for shapes that the board would refuse, or if the
  /// board stays busy, and InUse if this object does not drive the arm.
  void place_shapes(const Shapes& shapes);

  protocol::ParameterSet parameters();
  /// One transaction: all take effect at one control period, or none does and Refused is thrown.
  AcceptedTransaction set_parameters(std::span<const ParameterChange> changes);
  AcceptedTransaction restore_default_parameters();
  /// Each gets what the board's next start would give it. Throws Refused if the board has stored nothing.
  AcceptedTransaction restore_stored_parameters();
  /// What the board's next start would give each parameter: what it has stored, or the default.
  protocol::ParameterSet stored_parameters();
  /// What the board has stored. The commands that change it are in board_store.hpp.
  protocol::StoreReport store_report();

  /// What the board kept of the time around its last fault; its `fault` is none if it keeps nothing. Its counters, and
  /// those of its rows, are those of the board's run in which the fault came, and not widened.
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
