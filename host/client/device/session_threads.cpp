#include "host/client/device/session_threads.hpp"

#include <chrono>
#include <utility>

#include <fmt/format.h>

#include "host/client/device/wide_counter.hpp"

#include "host/client/device/thread_precedence.hpp"

namespace inkwell::device {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

constexpr auto search_interval = 200ms;
/// Another program may change the parameters, so they are read again after this interval. Board time is used because
/// requests would accumulate while board time is stopped.
constexpr std::int64_t refresh_periods = protocol::servo_rate_Hz;
constexpr auto rate_window = 500ms;
constexpr auto silence_limit = 2s;

/// The claim remains for this time between test pulses.
constexpr std::int64_t idle_claim_periods = 2 * protocol::servo_rate_Hz;

bool may_move_arm(protocol::Command command) {
  using protocol::Command;
  return command == Command::enable_force || command == Command::self_test || command == Command::test_current ||
         command == Command::test_voltage;
}

}  // namespace

Session::Implementation::Implementation(std::function<std::optional<Endpoint>()> find_device)
    : find(std::move(find_device)) {
  report_thread = std::thread([this] { report_loop(); });
  scope_thread = std::thread([this] { scope_loop(); });
}

Session::Implementation::~Implementation() {
  {
    const std::lock_guard lock(mutex);
    stopping = true;
    changed.notify_all();
  }
  report_thread.join();
  scope_thread.join();
}

// ---- report thread ------------------------------------------------------------------------------------------------

void Session::Implementation::report_loop() {
  request_priority();
  while (!stopping) {
    try {
      if (const auto endpoint = find())
        serve(connect(*endpoint));
      else
        set_connection(Connection::searching, "No arm was found. Plug in an arm, or start a virtual board.");
    } catch (const NoPermission& error) {
      set_connection(Connection::no_permission, error.what());
    } catch (const Incompatible& error) {
      set_connection(Connection::incompatible, error.what(), error.board_name);
    } catch (const Error& error) {
      set_connection(Connection::searching, error.what());
    }
    forget_device();
    std::unique_lock lock(mutex);
    changed.wait_for(lock, search_interval, [&] { return stopping.load(); });
  }
}

std::shared_ptr<Device> Session::Implementation::connect(const Endpoint& endpoint) {
  std::shared_ptr<Device> opened = Device::open(endpoint);
  const auto information = opened->information();
  const auto held = opened->parameters();
  const auto store = read_store(*opened);
  const std::lock_guard lock(mutex);
  const bool is_known = information.serial_number == served_serial_number;
  if (is_known) opened->continue_time(served_until_periods);
  if (parameter_set && is_known)
    newest_reconnection = Reconnection{reconnections + 1, requests.parameters.applied_to(*parameter_set), held};
  reconnections += newest_reconnection ? 1 : 0;
  served_serial_number = information.serial_number;
  state.information = information;
  state.board_name = information.board_name;
  state.store = store;
  state.is_simulation = endpoint.is_virtual;
  state.connection = Connection::connected;
  state.message = connected_message();
  scope_denied = false;
  parameter_set = held;
  ++revision;
  events.add(event_now(EventKind::connection,
                       fmt::format("Connected to {}{}, firmware {}.", state.is_simulation ? "the simulation " : "",
                                   information.serial_number, information.firmware_version),
                       std::nullopt));
  requests.select = !signals.empty();
  // The commands were queued for the lost device and must not reach another device.
  requests.commands.clear();
  requests.take_over = false;
  requests.store.reset();
  shared_device = opened;
  changed.notify_all();
  return opened;
}

void Session::Implementation::serve(const std::shared_ptr<Device>& served) {
  std::optional<std::int64_t> sequence;
  std::optional<std::int64_t> refreshed_at_periods;
  auto window_start = Clock::now(), last_pose = window_start;
  std::uint64_t poses_in_window = 0;
  std::int64_t newest_periods = 0;
  std::optional<Pose> before;
  std::uint8_t parity = 0;
  bool was_silent = false;
  std::optional<Pose> waiting;  ///< read to find out whether the previous pose is the newest pose
  while (!stopping) {
    if (const auto pose = waiting ? std::exchange(waiting, std::nullopt) : served->read_pose(1ms)) {
      waiting = served->read_pose(0ms);
      last_pose = Clock::now();
      ++poses_in_window;
      take_pose(*pose, sequence);
      pass_on(*served, *pose, !waiting);
      follow_fault(*served, *pose, refreshed_at_periods ? std::optional(newest_periods) : std::nullopt);
      newest_periods = pose->time_periods;
      note_events(std::exchange(before, pose), *pose);
      if (!refreshed_at_periods || before->driver_parity != parity) refresh_driver(*served);
      parity = before->driver_parity;
      release_idle(*served, *before);
      if (!refreshed_at_periods) refreshed_at_periods = newest_periods;
    }
    if (lost) throw Disconnected("The device was unplugged. Connect the device again.");
    send_requests(*served);
    served->keep_alive();
    const auto now = Clock::now();
    if (now - window_start >= rate_window) {
      const std::lock_guard lock(mutex);
      state.pose_rate_Hz =
          static_cast<double>(poses_in_window) / std::chrono::duration<double>(now - window_start).count();
      state.scope_frames_malformed = served->malformed_scope_frames();
      note_losses(newest_periods);
      const bool is_silent = now - last_pose > silence_limit;
      if (is_silent) state.message = "The device is connected but silent: it is paused or not working.";
      if (std::exchange(was_silent, is_silent) && !is_silent) state.message = connected_message();
      window_start = now;
      poses_in_window = 0;
    }
    if (refreshed_at_periods && newest_periods - *refreshed_at_periods >= refresh_periods) {
      refresh_parameters(*served);
      refresh_information(*served);
      refresh_store(*served);
      refresh_driver(*served);
      refreshed_at_periods = newest_periods;
      const std::lock_guard lock(mutex);
      if (scope_denied) requests.select = true;  // the other program may have released the scope
    }
  }
  send_requests(*served);  // includes final requests, such as a parameter restore
  if (served->drives() && Clock::now() - last_pose < silence_limit) let_force_fall(*served);
}

void Session::Implementation::let_force_fall(Device& device) {
  try {
    device.disable_force();
  } catch (const InUse&) {  // another program drives the arm now
  }
}

void Session::Implementation::release_idle(Device& device, const Pose& pose) {
  using protocol::State;
  if (!device.drives()) return;
  const bool is_needed = protocol::force_is_on(pose.state) || pose.state == State::testing;
  if (is_needed) claimed_at_periods = pose.time_periods;
  if (pose.time_periods - claimed_at_periods > idle_claim_periods) device.release();
}

void Session::Implementation::take_pose(const Pose& pose, std::optional<std::int64_t>& sequence) {
  const std::lock_guard lock(mutex);
  newest = pose;
  served_until_periods = pose.time_periods;
  ++state.poses_received;
  if (sequence && pose.sequence > *sequence)
    state.poses_lost += static_cast<std::uint64_t>(pose.sequence - *sequence - 1);
  sequence = pose.sequence;
}

void Session::Implementation::pass_on(Device& device, const Pose& pose, bool is_newest) {
  {
    const std::lock_guard lock(mutex);
    if (new_receive_pose) receive_pose = std::move(*new_receive_pose);
    new_receive_pose.reset();
  }
  const bool is_first = !std::exchange(passed_on, device.drives());
  if (is_first) receiver_failed = false;
  if (!passed_on || !receive_pose || receiver_failed) return;
  try {
    // Only this thread changes the parameters.
    receive_pose(device, {pose, *parameter_set, revision, is_first, is_newest});
  } catch (const Disconnected&) {
    throw;
  } catch (const Error& error) {
    receiver_failed = true;
    show_problem(error);
  }
}

void Session::Implementation::note_events(const std::optional<Pose>& before, const Pose& pose) {
  const std::lock_guard lock(mutex);
  events.add(events_between(before, pose, state.fault ? std::optional(state.fault->at_periods) : std::nullopt));
  if (!before) hand_events = {};
  events.add(hand_events.take(pose));
}

void Session::Implementation::note_losses(std::int64_t at_periods) {
  const auto note = [&](const char* what, std::uint64_t now, std::uint64_t& reported) {
    if (now > reported)
      events.add(event_now(EventKind::loss, fmt::format("{} {} were lost.", now - reported, what), at_periods));
    reported = now;
  };
  note("poses", state.poses_lost, reported_poses_lost);
  note("samples", state.scope_samples_lost, reported_samples_lost);
}

namespace {

std::optional<protocol::SelfTestReport> self_test_of(Device& device) {
  try {
    return device.read_self_test();
  } catch (const Stalled&) {  // the caller then uses the generic fault text
    return std::nullopt;
  }
}

}  // namespace

void Session::Implementation::follow_fault(Device& device, const Pose& pose,
                                           std::optional<std::int64_t> before_periods) {
  std::optional<NoticedFault> known;
  std::optional<protocol::SelfTestReport> test;
  {
    const std::lock_guard lock(mutex);
    known = state.fault;
  }
  if (pose.state == protocol::State::fault) {
    if (known && known->fault == pose.fault) return;
    known = {pose.fault, noticed_at_periods(device, pose, before_periods)};
    if (pose.fault == protocol::Fault::self_test_failed) test = self_test_of(device);
  } else if (!known) {
    return;
  } else {
    known.reset();
  }
  const std::lock_guard lock(mutex);
  state.fault = known;
  state.self_test = test;
}

std::int64_t Session::Implementation::noticed_at_periods(Device& device, const Pose& pose,
                                                         std::optional<std::int64_t> before_periods) {
  try {
    const protocol::BlackBoxReport box = device.black_box();
    const std::int64_t fault_periods = WideCounter::nearest_to(pose.time_periods, box.fault_periods);
    if (box.fault == pose.fault && box.is_restart == 0 && fault_periods <= pose.time_periods &&
        (!before_periods || fault_periods > *before_periods))
      return fault_periods;
  } catch (const Stalled&) {  // the pose then provides the time
  }
  return pose.time_periods;
}

void Session::Implementation::send_requests(Device& device) {
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
    if (taken.take_over) take_over(device);
    for (const auto& queued : taken.commands) carry_out(device, queued);
    if (taken.select) select(device, selection);
    is_at_parameters = true;
    if (restore_defaults) transact(device, [&] { return device.restore_default_parameters(); });
    restore_defaults = false;
    if (!changes.empty()) transact(device, [&device, &wanted = changes] { return device.set_parameters(wanted); });
  } catch (const Stalled&) {
    // The board refused the request and would refuse it again. Only this request is discarded.
    if (is_at_parameters && !std::exchange(restore_defaults, false)) changes.clear();
    put_back(std::move(taken.parameters));
    throw;
  } catch (const Error&) {
    put_back(std::move(taken.parameters));
    throw;
  }
  if (taken.store) carry_out(device, *taken.store);
}

void Session::Implementation::put_back(ParameterRequests unsent) {
  const std::lock_guard lock(mutex);
  requests.parameters.put_before(std::move(unsent));
}

void Session::Implementation::carry_out(Device& device, const QueuedCommand& queued) {
  using protocol::Command;
  try {
    if (may_move_arm(queued.command)) {
      if (!device.drives()) device.claim();
      const std::lock_guard lock(mutex);
      if (newest) claimed_at_periods = newest->time_periods;
    }
    if (queued.pulse) {
      device.carry_out(queued.command, *queued.pulse);
    } else {
      try {
        device.carry_out(queued.command);
      } catch (const InUse&) {
        if (queued.command != Command::disable_force) throw;
        device.carry_out(Command::stop);
      }
    }
    const std::lock_guard lock(mutex);
    state.command_problem.reset();
  } catch (const InUse& error) {
    show_problem(error);
  }
}

void Session::Implementation::take_over(Device& device) {
  try {
    device.take_over();
    const std::lock_guard lock(mutex);
    state.command_problem.reset();
    if (newest) claimed_at_periods = newest->time_periods;
  } catch (const InUse& error) {
    show_problem(error);
  }
}

void Session::Implementation::show_problem(const Error& error) {
  const std::lock_guard lock(mutex);
  state.command_problem = error.what();
  events.add(event_now(EventKind::connection, error.what(), std::nullopt));
}

void Session::Implementation::refresh_driver(Device& device) {
  const auto driver = device.driver();
  const std::lock_guard lock(mutex);
  state.driver = driver;
}

void Session::Implementation::carry_out(Device& device, StoreTask task) {
  std::optional<std::string> problem;
  try {
    if (task == StoreTask::store)
      device::store_parameters(device);
    else
      device::factory_reset(device);
  } catch (const Disconnected&) {
    throw;
  } catch (const Error& error) {
    problem = error.what();
  }
  const auto store = read_store(device);
  const auto held = device.parameters();
  const std::lock_guard lock(mutex);
  state.store = store;
  state.store_problem = problem;
  state.is_storing = requests.store.has_value();  // a newer request may be pending
  if (parameter_set == held) return;
  if (parameter_set) events.add(events_of_change(*parameter_set, held, std::nullopt));
  parameter_set = held;
  ++revision;
}

void Session::Implementation::select(Device& device, const std::vector<protocol::Signal>& selection) {
  std::optional<std::string> denial;
  try {
    device.select_signals(selection);
  } catch (const InUse& error) {  // only the scope is unavailable
    denial = error.what();
  }
  const std::lock_guard lock(mutex);
  if (denial || scope_denied) state.message = denial.value_or(connected_message());
  scope_denied = denial.has_value();
}

void Session::Implementation::refresh_parameters(Device& device) {
  const auto held = device.parameters();
  const std::lock_guard lock(mutex);
  if (parameter_set == held) return;
  if (parameter_set && newest)
    events.add(events_of_change(*parameter_set, held, newest->time_periods, ", by another program"));
  parameter_set = held;
  ++revision;
}

void Session::Implementation::refresh_information(Device& device) {
  const auto information = device.information();
  const std::lock_guard lock(mutex);
  state.information = information;
}

void Session::Implementation::refresh_store(Device& device) {
  auto store = *state.store;  // only this thread changes `state.store`
  const auto report = device.store_report();
  if (report.commands == store.report.commands && report.records_written == store.report.records_written)
    store.report = report;
  else
    store = read_store(device);
  const std::lock_guard lock(mutex);
  state.store = store;
}

void Session::Implementation::set_connection(Connection connection, const std::string& message,
                                             const std::string& board_name) {
  const std::lock_guard lock(mutex);
  state.board_name = board_name;
  state.connection = connection;
  state.message = message;
}

void Session::Implementation::forget_device() {
  const std::lock_guard lock(mutex);
  if (shared_device) events.add(event_now(EventKind::connection, "The device was disconnected.", std::nullopt));
  shared_device.reset();
  state.information.reset();
  state.store.reset();
  state.is_storing = false;
  newest_reconnection.reset();
  state.applied_at_periods.reset();
  state.fault.reset();
  state.pose_rate_Hz = 0;
  newest.reset();
  if (state.connection == Connection::connected) state.connection = Connection::searching;
  lost = false;
}

void Session::Implementation::queue_store_task(StoreTask task) {
  if (shared_device == nullptr) return;
  requests.store = task;
  state.is_storing = true;
  state.store_problem.reset();
}

// ---- scope thread ---------------------------------------------------------------------------------------------------

void Session::Implementation::scope_loop() {
  while (!stopping) {
    std::shared_ptr<Device> reading;
    std::function<void(const ScopeSamples&)> receive;
    {
      std::unique_lock lock(mutex);
      changed.wait_for(lock, search_interval, [&] { return stopping || shared_device != nullptr; });
      reading = shared_device;
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
      if (shared_device == reading) lost = true;  // the report thread may have reconnected already
    }
  }
}

}  // namespace inkwell::device
