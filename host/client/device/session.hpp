// A client that connects and reconnects automatically, sends the sign of life, and stores the newest pose. Separate
// threads access the device, so calls never wait for the device.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "host/client/device/board_store.hpp"
#include "host/client/device/device.hpp"
#include "host/client/device/event.hpp"

namespace inkwell::device {

enum class Connection : std::uint8_t { searching, connected, incompatible, no_permission };

/// The current fault of the device.
struct NoticedFault {
  protocol::Fault fault;
  /// The control period in which the fault was raised. If a fault is reported only after a restart, this is the period
  /// of the first pose with the fault.
  std::int64_t at_periods;
  bool operator==(const NoticedFault&) const = default;
};

struct SessionStatus {
  Connection connection = Connection::searching;
  std::string message;                     ///< a sentence for the user, with the remedy if there is one
  std::optional<Information> information;  ///< read every second
  std::string board_name;                  ///< also of an incompatible device; empty: not reported
  bool is_simulation = false;              ///< connected to a virtual board
  /// The control period at which the newest transaction of this session took effect; none before the first transaction.
  std::optional<std::int64_t> applied_at_periods;
  std::optional<NoticedFault> fault;                  ///< none: the device is not in the fault state
  std::optional<protocol::SelfTestReport> self_test;  ///< the results that led to the fault self_test_failed
  std::optional<BoardStore> store;                    ///< read once per second and after each request to change it
  bool is_storing = false;                            ///< a request to store or erase parameters is pending
  /// Why the newest request to store or erase parameters failed; none after a new request.
  std::optional<std::string> store_problem;
  /// The driver of the arm, updated every second and on each change; none if no program drives the arm.
  std::optional<Driver> driver;
  /// Why the newest command had no effect; none after a command was carried out.
  std::optional<std::string> command_problem;
  double pose_rate_Hz = 0;
  std::uint64_t poses_received = 0;
  std::uint64_t poses_lost = 0;
  std::uint64_t scope_samples_received = 0;
  std::uint64_t scope_samples_lost = 0;
  std::uint64_t scope_frames_malformed = 0;
};

/// The lost device after its reconnection.
struct Reconnection {
  std::uint64_t number = 0;         ///< increases with each reconnection
  protocol::ParameterSet before{};  ///< values when the device was lost, including pending changes
  protocol::ParameterSet after{};   ///< values after the reconnection; they differ if the device lost power
};

class Session {
 public:
  /// While no device is connected, `find` is called repeatedly to find a device.
  explicit Session(std::function<std::optional<Endpoint>()> find);
  /// Sends the queued requests if a device is connected.
  ~Session();

  SessionStatus status() const;
  std::optional<Pose> newest_pose() const;

  /// Queues a command, which is sent within a millisecond. A command that may move the arm first claims the arm for
  /// this session. The session releases the arm once the force is off. While another program drives the arm,
  /// disable_force acts as stop.
  void send(protocol::Command command);
  void send(protocol::Command command, const protocol::TestPulse& pulse);

  /// Queues a takeover of the arm from its current driver.
  void take_over();

  /// The current parameters of the device; `parameters_revision` increases with each connection, transaction and
  /// change.
  std::optional<protocol::ParameterSet> parameters() const;
  std::uint64_t parameters_revision() const;
  /// Queues one transaction. Changes that were queued since the last transaction are merged into one transaction.
  void set_parameters(std::vector<ParameterChange> changes);
  void restore_default_parameters();
  /// Stores the board's parameters after the pending changes were sent. The request has no effect without a device and
  /// is not repeated after a disconnection.
  void store_parameters();
  /// Erases the stored parameters and sets every parameter to its default.
  void factory_reset();
  /// The newest reconnection of the connected device. None before the first reconnection, without a device, or if the
  /// connected device is not the lost device.
  std::optional<Reconnection> reconnection() const;
  /// The refusal of the newest transaction; empty after an accepted transaction.
  std::optional<std::string> refusal() const;

  /// The events since the last call; if there are too many, only the newest events.
  std::vector<Event> take_events();

  /// Selects these signals for every control period. The selection is repeated after each reconnection.
  void select_signals(std::vector<protocol::Signal> signals);
  /// The session's scope thread calls `receive` with every frame. Set `receive` before the first selection.
  void on_scope(std::function<void(const ScopeSamples&)> receive);

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace inkwell::device
