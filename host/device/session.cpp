#include <device/session.hpp>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <thread>
#include <utility>

#include "thread_precedence.hpp"

namespace inkwell::device {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

constexpr auto search_interval = 200ms;
/// Another program may have changed the parameters. A second of the device's time: while that stands still, nothing
/// shall pile up before a change that the user makes.
constexpr std::uint32_t refresh_periods = protocol::servo_rate_Hz;
constexpr auto rate_window = 500ms;
constexpr auto silence_limit = 2s;

struct QueuedCommand {
  protocol::Command command;
  std::optional<protocol::TestPulse> pulse;
};

/// What shall become of the parameters: first the defaults, if they are asked for, then the changes.
struct ParameterRequests {
  bool restore_defaults = false;
  std::vector<ParameterChange> changes;
};

/// What the caller asked for and the report thread has not sent yet.
struct Requests {
  std::vector<QueuedCommand> commands;
  ParameterRequests parameters;
  bool select = false;
};

/// A later value of the same parameter takes the place of the earlier one: a transaction names each once.
void merge(std::vector<ParameterChange>& into, const std::vector<ParameterChange>& changes) {
  for (const auto& change : changes) {
    const auto same =
        std::find_if(into.begin(), into.end(), [&](const auto& old) { return old.first == change.first; });
    if (same != into.end())
      same->second = change.second;
    else
      into.push_back(change);
  }
}

}  // namespace

struct Session::Implementation {
  explicit Implementation(std::function<std::optional<Endpoint>()> find_device) : find(std::move(find_device)) {
    report_thread = std::thread([this] { report_loop(); });
    scope_thread = std::thread([this] { scope_loop(); });
  }

  ~Implementation() {
    {
      const std::lock_guard lock(mutex);
      stopping = true;
      changed.notify_all();
    }
    report_thread.join();
    scope_thread.join();
  }

  // ---- the report thread: connects, reads poses, sends what was asked for --------------------------------

  void report_loop() {
    ask_for_precedence();
    while (!stopping) {
      try {
        if (const auto endpoint = find())
          serve(connect(*endpoint));
        else
          set_connection(Connection::searching, "No arm was found. Plug one in, or start a virtual one.");
      } catch (const NoPermission& error) {
        set_connection(Connection::no_permission, error.what());
      } catch (const Incompatible& error) {
        set_connection(Connection::incompatible, error.what());
      } catch (const Error& error) {
        set_connection(Connection::searching, error.what());
      }
      forget_device();
      std::unique_lock lock(mutex);
      changed.wait_for(lock, search_interval, [&] { return stopping.load(); });
    }
  }

  std::shared_ptr<Device> connect(const Endpoint& endpoint) {
    std::shared_ptr<Device> opened = Device::open(endpoint);
    const auto information = opened->information();
    const auto held = opened->parameters();
    const std::lock_guard lock(mutex);
    state.information = information;
    state.is_simulation = endpoint.is_virtual;
    state.connection = Connection::connected;
    state.message = connected_message();
    scope_denied = false;
    parameter_set = held;
    ++revision;
    requests.select = !signals.empty();
    // A command for the device that went away must not reach the one that came; parameter changes may.
    requests.commands.clear();
    device = opened;
    changed.notify_all();
    return opened;
  }

  void serve(const std::shared_ptr<Device>& served) {
    std::optional<std::uint32_t> sequence;
    std::optional<std::uint32_t> refreshed_at_periods;
    auto window_start = Clock::now(), last_pose = window_start;
    std::uint64_t poses_in_window = 0;
    std::uint32_t newest_periods = 0;
    while (!stopping) {
      if (const auto pose = served->read_pose(1ms)) {
        last_pose = Clock::now();
        ++poses_in_window;
        take_pose(*pose, sequence);
        follow_fault(*served, *pose, refreshed_at_periods ? std::optional(newest_periods) : std::nullopt);
        newest_periods = pose->time_periods;
        if (!refreshed_at_periods) refreshed_at_periods = newest_periods;
      }
      if (lost) throw Disconnected("The device was unplugged. Connect it again.");
      send_requests(*served);
      served->keep_alive();
      const auto now = Clock::now();
      if (now - window_start >= rate_window) {
        const std::lock_guard lock(mutex);
        state.pose_rate_Hz =
            static_cast<double>(poses_in_window) / std::chrono::duration<double>(now - window_start).count();
        state.scope_frames_malformed = served->malformed_scope_frames();
        if (now - last_pose > silence_limit)
          state.message = "The device is connected but silent: it is paused or stuck.";
        window_start = now;
        poses_in_window = 0;
      }
      if (refreshed_at_periods && newest_periods - *refreshed_at_periods >= refresh_periods) {
        refresh_parameters(*served);
        refresh_information(*served);
        refreshed_at_periods = newest_periods;
        const std::lock_guard lock(mutex);
        if (scope_denied) requests.select = true;  // the other program may be done
      }
    }
    send_requests(*served);  // what was asked for last, such as to put parameters back
  }

  void take_pose(const protocol::PoseReport& pose, std::optional<std::uint32_t>& sequence) {
    const std::lock_guard lock(mutex);
    newest = pose;
    ++state.poses_received;
    if (sequence) state.poses_lost += pose.sequence - *sequence - 1;
    sequence = pose.sequence;
  }

  /// `before_periods`: of the pose before this one, if there was one.
  void follow_fault(Device& from, const protocol::PoseReport& pose, std::optional<std::uint32_t> before_periods) {
    std::optional<NoticedFault> known;
    {
      const std::lock_guard lock(mutex);
      known = state.fault;
    }
    if (pose.state == protocol::State::fault) {
      if (known && known->fault == pose.fault) return;
      known = {pose.fault, noticed_at_periods(from, pose, before_periods)};
    } else if (!known) {
      return;
    } else {
      known.reset();
    }
    const std::lock_guard lock(mutex);
    state.fault = known;
  }

  /// The black box knows the very period, unless it still keeps an older fault.
  static std::uint32_t noticed_at_periods(Device& by, const protocol::PoseReport& pose,
                                          std::optional<std::uint32_t> before_periods) {
    const auto comes_after = [](std::uint32_t a, std::uint32_t b) { return static_cast<std::int32_t>(a - b) > 0; };
    try {
      const protocol::BlackBoxReport box = by.black_box();
      if (box.fault == pose.fault && box.is_restart == 0 && !comes_after(box.fault_periods, pose.time_periods) &&
          (!before_periods || comes_after(box.fault_periods, *before_periods)))
        return box.fault_periods;
    } catch (const Stalled&) {  // then the pose tells it as well as one can
    }
    return pose.time_periods;
  }

  void send_requests(Device& to) {
    Requests taken;
    std::vector<protocol::Signal> selection;
    {
      const std::lock_guard lock(mutex);
      taken = std::exchange(requests, {});
      selection = signals;
    }
    auto& [restore_defaults, changes] = taken.parameters;
    bool is_at_parameters = false;
    try {
      for (const auto& queued : taken.commands) {
        if (queued.pulse)
          to.send(queued.command, *queued.pulse);
        else
          to.send(queued.command);
      }
      if (taken.select) select(to, selection);
      is_at_parameters = true;
      if (restore_defaults) transact(to, [&] { return to.restore_default_parameters(); });
      restore_defaults = false;
      if (!changes.empty()) transact(to, [&to, &wanted = changes] { return to.set_parameters(wanted); });
    } catch (const Stalled&) {
      // Sent again, it would be refused again; what stands behind it was not sent yet.
      if (is_at_parameters && !std::exchange(restore_defaults, false)) changes.clear();
      put_back(std::move(taken.parameters));
      throw;
    } catch (const Error&) {
      put_back(std::move(taken.parameters));
      throw;
    }
  }

  /// For the next connection. What was asked for since comes after it.
  void put_back(ParameterRequests unsent) {
    const std::lock_guard lock(mutex);
    if (requests.parameters.restore_defaults) return;  // overwritten since
    merge(unsent.changes, requests.parameters.changes);
    requests.parameters = std::move(unsent);
  }

  void select(Device& to, const std::vector<protocol::Signal>& selection) {
    std::optional<std::string> denial;
    try {
      to.select_signals(selection);
    } catch (const InUse& error) {  // all but the scope goes on
      denial = error.what();
    }
    const std::lock_guard lock(mutex);
    if (denial || scope_denied) state.message = denial.value_or(connected_message());
    scope_denied = denial.has_value();
  }

  template <class Transaction>
  void transact(Device& with, Transaction transaction) {
    std::optional<std::string> refused;
    std::optional<std::uint32_t> applied_at_periods;
    try {
      applied_at_periods = transaction().applied_at_periods;
    } catch (const Refused& error) {
      refused = error.what();
    }
    const auto held = with.parameters();
    const std::lock_guard lock(mutex);
    newest_refusal = refused;
    if (applied_at_periods) state.applied_at_periods = applied_at_periods;
    parameter_set = held;
    ++revision;
  }

  void refresh_parameters(Device& from) {
    const auto held = from.parameters();
    const std::lock_guard lock(mutex);
    if (parameter_set == held) return;
    parameter_set = held;
    ++revision;
  }

  /// Counters and the motors' heat change; the rest of it stays.
  void refresh_information(Device& from) {
    const auto information = from.information();
    const std::lock_guard lock(mutex);
    state.information = information;
  }

  std::string connected_message() const { return "Connected to " + state.information->serial_number + "."; }

  void set_connection(Connection connection, const std::string& message) {
    const std::lock_guard lock(mutex);
    state.connection = connection;
    state.message = message;
  }

  void forget_device() {
    const std::lock_guard lock(mutex);
    device.reset();
    state.information.reset();
    state.applied_at_periods.reset();
    state.fault.reset();
    state.pose_rate_Hz = 0;
    newest.reset();
    if (state.connection == Connection::connected) state.connection = Connection::searching;
    lost = false;
  }

  // ---- the scope thread ----------------------------------------------------------------------------------

  void scope_loop() {
    while (!stopping) {
      std::shared_ptr<Device> reading;
      std::function<void(const ScopeSamples&)> receive;
      {
        std::unique_lock lock(mutex);
        changed.wait_for(lock, search_interval, [&] { return stopping || device != nullptr; });
        reading = device;
        receive = receive_scope;
      }
      if (reading == nullptr || lost) {
        std::this_thread::sleep_for(1ms);
        continue;
      }
      try {
        if (const auto samples = reading->read_scope(20ms)) {
          {
            const std::lock_guard lock(mutex);
            state.scope_samples_received += samples->count;
            state.scope_samples_lost += samples->lost_before;
          }
          if (receive) receive(*samples);
        }
      } catch (const Error&) {
        const std::lock_guard lock(mutex);
        if (device == reading) lost = true;  // the report thread reconnects, unless it has done so already
      }
    }
  }

  std::function<std::optional<Endpoint>()> find;
  mutable std::mutex mutex;
  std::condition_variable changed;
  std::atomic<bool> stopping = false;
  std::atomic<bool> lost = false;
  std::shared_ptr<Device> device;
  SessionStatus state;
  std::optional<protocol::PoseReport> newest;
  std::optional<protocol::ParameterSet> parameter_set;
  std::uint64_t revision = 0;
  std::optional<std::string> newest_refusal;
  Requests requests;
  std::vector<protocol::Signal> signals;
  bool scope_denied = false;  ///< another program has it
  std::function<void(const ScopeSamples&)> receive_scope;
  std::thread report_thread, scope_thread;  ///< last: they use all of the above
};

Session::Session(std::function<std::optional<Endpoint>()> find)
    : implementation_(std::make_unique<Implementation>(std::move(find))) {}
Session::~Session() = default;

SessionStatus Session::status() const {
  const std::lock_guard lock(implementation_->mutex);
  return implementation_->state;
}

std::optional<protocol::PoseReport> Session::newest_pose() const {
  const std::lock_guard lock(implementation_->mutex);
  return implementation_->newest;
}

void Session::send(protocol::Command command) {
  const std::lock_guard lock(implementation_->mutex);
  implementation_->requests.commands.push_back({command, std::nullopt});
}

void Session::send(protocol::Command command, const protocol::TestPulse& pulse) {
  const std::lock_guard lock(implementation_->mutex);
  implementation_->requests.commands.push_back({command, pulse});
}

std::optional<protocol::ParameterSet> Session::parameters() const {
  const std::lock_guard lock(implementation_->mutex);
  return implementation_->parameter_set;
}

std::uint64_t Session::parameters_revision() const {
  const std::lock_guard lock(implementation_->mutex);
  return implementation_->revision;
}

void Session::set_parameters(std::vector<ParameterChange> changes) {
  const std::lock_guard lock(implementation_->mutex);
  merge(implementation_->requests.parameters.changes, changes);
}

void Session::restore_default_parameters() {
  const std::lock_guard lock(implementation_->mutex);
  implementation_->requests.parameters = {.restore_defaults = true};  // which overwrite the changes asked for before
}

std::optional<std::string> Session::refusal() const {
  const std::lock_guard lock(implementation_->mutex);
  return implementation_->newest_refusal;
}

void Session::select_signals(std::vector<protocol::Signal> signals) {
  const std::lock_guard lock(implementation_->mutex);
  implementation_->signals = std::move(signals);
  implementation_->requests.select = true;
}

void Session::on_scope(std::function<void(const ScopeSamples&)> receive) {
  const std::lock_guard lock(implementation_->mutex);
  implementation_->receive_scope = std::move(receive);
}

}  // namespace inkwell::device
