// A client that connects automatically, sends heartbeats and stores the newest pose. Its calls do not wait for the
// device, because separate threads access the device.
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

struct NoticedFault {
  protocol::Fault fault;
  /// The control period in which the fault was raised. If this period is unknown, the control period of the first pose
  /// with this fault.
  std::int64_t at_periods;
  bool operator==(const NoticedFault&) const = default;
};

struct SessionStatus {
  Connection connection = Connection::searching;
  std::string message;                     ///< a message for the user
  std::optional<Information> information;  ///< updated once per second
  std::string board_name;                  ///< also set for an incompatible device; empty: not reported
  bool is_simulation = false;              ///< the device is a virtual board
  /// The control period in which the newest transaction took effect; std::nullopt before the first transaction.
  std::optional<std::int64_t> applied_at_periods;
  std::optional<NoticedFault> fault;                  ///< std::nullopt outside the fault state
  std::optional<protocol::SelfTestReport> self_test;  ///< results of the failed self-test
  std::optional<BoardStore> store;                    ///< updated once per second and after each store request
  bool is_storing = false;                            ///< a request to store or erase the parameters is pending
  /// The reason why the newest store request failed. A new request resets this value.
  std::optional<std::string> store_problem;
  /// The driver of the arm, updated once per second and after each change; std::nullopt without a driver.
  std::optional<Driver> driver;
  /// The reason why the newest command had no effect. The next executed command resets this value.
  std::optional<std::string> command_problem;
  double pose_rate_Hz = 0;
  std::uint64_t poses_received = 0;
  std::uint64_t poses_lost = 0;
  std::uint64_t scope_samples_received = 0;
  std::uint64_t scope_samples_lost = 0;
  std::uint64_t scope_frames_malformed = 0;
};

struct Reconnection {
  std::uint64_t number = 0;         ///< increases by 1 with each reconnection
  protocol::ParameterSet before{};  ///< parameter values before the disconnection, with all pending changes
  protocol::ParameterSet after{};   ///< parameter values after the reconnection
};

/// A pose that arrived while the session drives the arm.
struct DrivenPose {
  const Pose& pose;
  const protocol::ParameterSet& parameters;
  std::uint64_t parameters_revision;  ///< increases with each change of the parameters
  bool is_first;                      ///< first pose since this session has become the driver
  bool is_newest;                     ///< false if the next pose has already arrived
};

class Session {
 public:
  /// Calls `find` repeatedly while no device is connected.
  explicit Session(std::function<std::optional<Endpoint>()> find);
  /// Sends the queued requests if a device is connected.
  ~Session();

  SessionStatus status() const;
  std::optional<Pose> newest_pose() const;

  /// Queues a command, which is sent within a millisecond. Before a command that may move the arm, the session claims
  /// the arm. The session releases the arm after the force was switched off. If another program drives the arm,
  /// disable_force acts like stop.
  void send(protocol::Command command);
  void send(protocol::Command command, const protocol::TestPulse& pulse);

  /// Queues a takeover from the program that drives the arm.
  void take_over();

  /// Returns the current parameters of the device. `parameters_revision` increases with each connection, transaction
  /// and change.
  std::optional<protocol::ParameterSet> parameters() const;
  std::uint64_t parameters_revision() const;
  /// Queues the changes. All queued changes are sent in one transaction.
  void set_parameters(std::vector<ParameterChange> changes);
  void restore_default_parameters();
  /// Stores the parameters of the board after all pending changes were sent. Without a device, the request is ignored.
  /// A disconnection cancels the request.
  void store_parameters();
  /// Erases the stored parameters and sets every parameter to its default.
  void factory_reset();
  /// Returns the newest reconnection to the connected device. Returns std::nullopt if the device is new or not
  /// connected.
  std::optional<Reconnection> reconnection() const;
  /// Returns the reason why the newest transaction was refused, or an empty optional if the transaction was accepted.
  std::optional<std::string> refusal() const;

  /// Returns the events since the last call. If the log is full, the oldest events are missing.
  std::vector<Event> take_events();

  /// Selects signals for every control period. The session repeats the selection after each reconnection.
  void select_signals(std::vector<protocol::Signal> signals);
  /// The session's scope thread calls `receive` for every frame. Call on_scope() before the first selection.
  void on_scope(std::function<void(const ScopeSamples&)> receive);
  /// The session's report thread calls `receive` for every pose while this session drives the arm. `receive` may send
  /// forces and local models. It must neither wait nor allocate memory, except at the first pose of a claim. If
  /// `receive` throws Error, the session shows the message and does not call `receive` again until the next claim.
  void on_pose(std::function<void(Device&, const DrivenPose&)> receive);

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace inkwell::device
