// The two threads of a session and what they share.
#pragma once

#include <atomic>
#include <condition_variable>
#include <mutex>
#include <thread>

#include <device/session.hpp>

#include "parameter_requests.hpp"

namespace inkwell::device {

struct QueuedCommand {
  protocol::Command command;
  std::optional<protocol::TestPulse> pulse;
};

enum class StoreTask : std::uint8_t { store, forget };

/// What the caller asked for and the report thread has not sent yet.
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

  // ---- the report thread: connects, reads poses, sends what was asked for --------------------------------

  void report_loop();
  std::shared_ptr<Device> connect(const Endpoint& endpoint);
  void serve(const std::shared_ptr<Device>& served);
  void take_pose(const Pose& pose, std::optional<std::int64_t>& sequence);
  void note_events(const std::optional<Pose>& before, const Pose& pose);
  /// Together for as long as a rate is counted, so that a bad cable does not fill the log. Call with the lock held.
  void note_losses(std::int64_t at_periods);
  /// `before_periods`: of the pose before this one, if there was one.
  void follow_fault(Device& from, const Pose& pose, std::optional<std::int64_t> before_periods);
  /// The black box knows the very period, unless it still keeps an older fault.
  static std::int64_t noticed_at_periods(Device& by, const Pose& pose, std::optional<std::int64_t> before_periods);
  void send_requests(Device& to);
  /// What the board refuses is shown to the user, and no reason to give the connection up.
  void carry_out(Device& by, const QueuedCommand& queued);
  void take_over(Device& from);
  void show_problem(const InUse& error);
  /// A session that drives the arm and leaves switches the force off; otherwise the board would raise a fault.
  void let_force_fall(Device& of);
  /// Releases the arm some time after this session has needed it.
  void release_idle(Device& of, const Pose& pose);
  /// For the next connection. What was asked for since comes after it.
  void put_back(ParameterRequests unsent);
  /// What the board refuses is told to the user, and no reason to give the connection up.
  void carry_out(Device& by, StoreTask task);
  void select(Device& to, const std::vector<protocol::Signal>& selection);
  template <class Transaction>
  void transact(Device& with, Transaction transaction) {
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
    const auto held = with.parameters();
    const std::lock_guard lock(mutex);
    newest_refusal = refused;
    if (refused) events.add(event_now(EventKind::parameter, *refused, std::nullopt));
    if (applied_at_periods) state.applied_at_periods = applied_at_periods;
    if (parameter_set) events.add(events_of_change(*parameter_set, held, applied_at_periods));
    parameter_set = held;
    ++revision;
  }
  void refresh_parameters(Device& from);
  /// Counters and the motors' heat change; the rest of it stays.
  void refresh_information(Device& from);
  void refresh_driver(Device& from);
  /// The stored values change with the count of records only.
  void refresh_store(Device& from);
  std::string connected_message() const { return "Connected to " + state.information->serial_number + "."; }
  void set_connection(Connection connection, const std::string& message, const std::string& board_name = {});
  void forget_device();
  /// With the mutex held. Without a device it would be carried out on whichever comes.
  void ask(StoreTask task);

  // ---- the scope thread ----------------------------------------------------------------------------------

  void scope_loop();

  std::function<std::optional<Endpoint>()> find;
  mutable std::mutex mutex;
  std::condition_variable changed;
  std::atomic<bool> stopping = false;
  std::atomic<bool> lost = false;
  std::shared_ptr<Device> device;
  SessionStatus state;
  std::optional<Pose> newest;
  std::optional<protocol::ParameterSet> parameter_set;
  std::uint64_t revision = 0;
  std::int64_t claimed_at_periods = 0;    ///< when this session last needed the arm
  std::string served_serial_number;       ///< of the device that is connected, or was last
  std::int64_t served_until_periods = 0;  ///< its newest pose
  std::optional<Reconnection> newest_reconnection;
  std::uint64_t reconnections = 0;
  std::optional<std::string> newest_refusal;
  EventLog events;
  std::uint64_t told_poses_lost = 0, told_samples_lost = 0;
  Requests requests;
  std::vector<protocol::Signal> signals;
  bool scope_denied = false;  ///< another program has it
  std::function<void(const ScopeSamples&)> receive_scope;
  std::thread report_thread, scope_thread;  ///< last: they use all of the above
};

}  // namespace inkwell::device
