// A client that looks after itself: connects and reconnects, keeps the host's sign of life, holds the
// newest pose and the scope's history. Its own threads talk to the device; the caller never waits.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <device/board_store.hpp>
#include <device/device.hpp>
#include <device/event.hpp>

namespace inkwell::device {

enum class Connection : std::uint8_t { searching, connected, incompatible, no_permission };

/// A fault that the device is in.
struct NoticedFault {
  protocol::Fault fault;
  /// The control period that noticed it, or, of a fault that a start tells afterwards, that of the first pose with it.
  std::int64_t at_periods;
  bool operator==(const NoticedFault&) const = default;
};

struct SessionStatus {
  Connection connection = Connection::searching;
  std::string message;                     ///< a sentence for the user, with the remedy where there is one
  std::optional<Information> information;  ///< read anew every second
  std::string board_name;                  ///< of the device, though it be incompatible; empty: it tells none
  bool is_simulation = false;              ///< connected to a virtual board
  /// The control period at which the newest transaction of this session took effect; none before the first.
  std::optional<std::int64_t> applied_at_periods;
  std::optional<NoticedFault> fault;                  ///< none: the device is in no fault
  std::optional<protocol::SelfTestReport> self_test;  ///< that led to the fault self_test_failed
  std::optional<BoardStore> store;  ///< as of the newest second, or of the newest request to change it
  bool is_storing = false;          ///< a request to store or to forget is on its way
  /// Why the newest request to store or to forget came to nothing; none once another was made.
  std::optional<std::string> store_problem;
  /// The program that drives the arm, as of the newest second or change; none if no program does.
  std::optional<Driver> driver;
  /// Why the newest command had no effect; none once another was carried out.
  std::optional<std::string> command_problem;
  double pose_rate_Hz = 0;
  std::uint64_t poses_received = 0;
  std::uint64_t poses_lost = 0;
  std::uint64_t scope_samples_received = 0;
  std::uint64_t scope_samples_lost = 0;
  std::uint64_t scope_frames_malformed = 0;
};

/// The device that was lost is connected again.
struct Reconnection {
  std::uint64_t number = 0;         ///< rises with each
  protocol::ParameterSet before{};  ///< that it held when it was lost, with what was then on its way to it
  protocol::ParameterSet after{};   ///< that it held when it came back, which is something else if it lost its power
};

class Session {
 public:
  /// `find` is asked again and again for the device to connect to while there is none.
  explicit Session(std::function<std::optional<Endpoint>()> find);
  /// Sends what is still queued, if the device is there.
  ~Session();

  SessionStatus status() const;
  std::optional<Pose> newest_pose() const;

  /// Queues a command; it is sent within a millisecond. Whatever may move the arm first claims it for this session,
  /// which releases it once the force is off. A disable_force is a stop while another program drives the arm.
  void send(protocol::Command command);
  void send(protocol::Command command, const protocol::TestPulse& pulse);

  /// Queues a takeover of the arm from the program that drives it.
  void take_over();

  /// The parameters as the device holds them; `parameters_revision` rises when they were read anew.
  std::optional<protocol::ParameterSet> parameters() const;
  std::uint64_t parameters_revision() const;
  /// Queues one transaction. Changes queued before the last one was sent are merged into it.
  void set_parameters(std::vector<ParameterChange> changes);
  void restore_default_parameters();
  /// Has the board store its parameters, once it has those that wait. Nothing without a device, and not
  /// repeated after a loss.
  void store_parameters();
  /// Has the board forget what it has stored and hold its defaults.
  void factory_reset();
  /// The newest one, while the device is connected; none before the first, and for another device than the one lost.
  std::optional<Reconnection> reconnection() const;
  /// The refusal of the newest transaction, if it was refused; empty once another was accepted.
  std::optional<std::string> refusal() const;

  /// What has happened since the last call; of very much the newest.
  std::vector<Event> take_events();

  /// Asks for these signals at every control period, from now on and after each reconnection.
  void select_signals(std::vector<protocol::Signal> signals);
  /// Called from the session's scope thread with every frame. Set before the first selection.
  void on_scope(std::function<void(const ScopeSamples&)> receive);

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace inkwell::device
