// Threads and shared state of a session.
#pragma once

#include <atomic>
#include <condition_variable>
#include <mutex>
#include <thread>

#include "host/client/device/session.hpp"

#include "host/client/device/hand_events.hpp"
#include "host/client/device/parameter_requests.hpp"

namespace inkwell::device {

struct QueuedCommand {
  protocol::Command command;
  std::optional<protocol::TestPulse> pulse;
};

enum class StoreTask : std::uint8_t { store, forget };

/// Requests that are waiting for the report thread.
struct Requests {
  std::vector<QueuedCommand> commands;
  ParameterRequests parameters;
  std::optional<StoreTask> store;
  bool select = false;
  bool take_over = false;
};

struct Session::Implementation {
  explicit Implementation(std::function<std::optional<Endpoint>()> find_device);
  ~Implementation();

  // ---- report thread ------------------------------------------------------------------------------------------------

  void report_loop();
  std::shared_ptr<Device> connect(const Endpoint& endpoint);
  void serve(const std::shared_ptr<Device>& served);
  void take_pose(const Pose& pose, std::optional<std::int64_t>& sequence);
  /// Calls the receiver of poses if this session drives the arm.
  void pass_on(Device& device, const Pose& pose, bool is_newest);
  void note_events(const std::optional<Pose>& before, const Pose& pose);
  /// Logs all losses of one rate window as one event, because a bad cable could fill the log. Requires the mutex.
  void note_losses(std::int64_t at_periods);
  /// `before_periods` is the time of the previous pose, if any.
  void follow_fault(Device& device, const Pose& pose, std::optional<std::int64_t> before_periods);
  /// Returns the period of the fault from the black box. If the black box contains another fault, returns the time of
  /// the pose.
  static std::int64_t noticed_at_periods(Device& device, const Pose& pose, std::optional<std::int64_t> before_periods);
  void send_requests(Device& device);
  /// Shows a refusal to the user. A refusal does not close the connection.
  void carry_out(Device& device, const QueuedCommand& queued);
  void take_over(Device& device);
  void show_problem(const Error& error);
  /// Fades the force out before a session closes. Otherwise the board would raise a fault.
  void let_force_fall(Device& device);
  /// Releases the arm if this session has not used it recently.
  void release_idle(Device& device, const Pose& pose);
  /// Queues unsent requests again before newer requests.
  void put_back(ParameterRequests unsent);
  /// Shows a refusal to the user. A refusal does not close the connection.
  void carry_out(Device& device, StoreTask task);
  void select(Device& device, const std::vector<protocol::Signal>& selection);
  template <class Transaction>
  void transact(Device& device, Transaction transaction) {
    std::optional<std::string> refused;
    std::optional<std::int64_t> applied_at_periods;
    try {
      applied_at_periods = transaction().applied_at_periods;
    } catch (const Refused& error) {
      refused = error.what();
    } catch (const InUse& error) {
      refused = error.what();
      show_problem(error);
    }
    const auto held = device.parameters();
    const std::lock_guard lock(mutex);
    newest_refusal = refused;
    if (refused) events.add(event_now(EventKind::parameter, *refused, std::nullopt));
    if (applied_at_periods) state.applied_at_periods = applied_at_periods;
    if (parameter_set) events.add(events_of_change(*parameter_set, held, applied_at_periods));
    parameter_set = held;
    ++revision;
  }
  void refresh_parameters(Device& device);
  void refresh_information(Device& device);
  void refresh_driver(Device& device);
  /// Reads the stored values only if the report has changed.
  void refresh_store(Device& device);
  std::string connected_message() const { return "Connected to " + state.information->serial_number + "."; }
  void set_connection(Connection connection, const std::string& message, const std::string& board_name = {});
  void forget_device();
  /// Requires the mutex. Ignores the request if no device is connected.
  void queue_store_task(StoreTask task);

  // ---- scope thread
  // ---------------------------------------------------------------------------------------------------

  void scope_loop();

  std::function<std::optional<Endpoint>()> find;
  mutable std::mutex mutex;
  std::condition_variable changed;
  std::atomic<bool> stopping = false;
  std::atomic<bool> lost = false;
  std::shared_ptr<Device> shared_device;
  SessionStatus state;
  std::optional<Pose> newest;
  std::optional<protocol::ParameterSet> parameter_set;
  std::uint64_t revision = 0;
  std::int64_t claimed_at_periods = 0;    ///< time when this session last needed the arm
  std::string served_serial_number;       ///< of the current or last device
  std::int64_t served_until_periods = 0;  ///< time of the newest pose from this device
  std::optional<Reconnection> newest_reconnection;
  std::uint64_t reconnections = 0;
  std::optional<std::string> newest_refusal;
  EventLog events;
  HandEvents hand_events;
  std::uint64_t reported_poses_lost = 0, reported_samples_lost = 0;
  Requests requests;
  std::vector<protocol::Signal> signals;
  bool scope_denied = false;  ///< another program uses the scope
  std::function<void(const ScopeSamples&)> receive_scope;
  std::optional<std::function<void(Device&, const DrivenPose&)>> new_receive_pose;  ///< for the report thread
  std::function<void(Device&, const DrivenPose&)> receive_pose;                     ///< only for the report thread
  bool passed_on = false;                                                           ///< the previous pose was passed on
  bool receiver_failed = false;                                                     ///< during this claim
  std::thread report_thread, scope_thread;  ///< declared last, because the threads use all other members
};

}  // namespace inkwell::device
