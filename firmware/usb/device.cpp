#include "firmware/usb/device.hpp"

#include <algorithm>
#include <utility>

#include "firmware/usb/controller_report.hpp"
#include "firmware/usb/descriptors.hpp"

namespace inkwell::usb {

namespace {

namespace identity = protocol::usb;

/// Largest number of events in one poll. The bus produces fewer events in 50 us, so no event is delayed.
constexpr int events_per_poll = 8;

constexpr std::size_t hid_in = 0, hid_out = 1, scope_in = 2, controller_in = 3;  // indices in endpoints_

/// Time for the replacement of a loaded report by a newer report. A replacement must be complete before the next
/// control interrupt and before the next start of frame. While a report is replaced, the host cannot read a report.
constexpr float pose_replacing_s = 8e-6f;

/// Time in which the main loop detects a new pose, fills the scope FIFO and loads the pose. The final pose is sampled
/// shortly before the start of frame.
constexpr float pose_loading_s = 12e-6f + pose_replacing_s;

/// Time between the loading of the spare pose and the loading of the final pose. A transaction of all parameters
/// delays the main loop by up to 0.3 ms, including control interrupts.
constexpr float spare_pose_lead_s = 8.0f * protocol::servo_period_s;

/// After 0.1 s of unread reports, the device assumes that the host does not poll. Without a polling host, unread
/// reports do not count as dropped.
constexpr std::uint32_t replaced_unheard = protocol::pose_rate_Hz / 10;

constexpr std::int32_t cycles_in(float time_s, const Identity& identity) {
  return static_cast<std::int32_t>(time_s * static_cast<float>(identity.processor_clock_Hz));
}

}  // namespace

Device::Device(Port& port, link::Link& link, const Identity& identity)
    : port_(port),
      link_(link),
      identity_(identity),
      pose_loading_cycles_(cycles_in(pose_loading_s, identity)),
      spare_pose_lead_cycles_(cycles_in(spare_pose_lead_s, identity)),
      pose_replacing_cycles_(cycles_in(pose_replacing_s, identity)),
      period_cycles_(cycles_in(protocol::servo_period_s, identity)),
      control_(port, *this),
      endpoints_{{{identity::hid_in_endpoint, EndpointType::interrupt, identity::hid_interface},
                  {identity::hid_out_endpoint, EndpointType::interrupt, identity::hid_interface},
                  {identity::scope_in_endpoint, EndpointType::bulk, identity::scope_interface},
                  {identity::controller_in_endpoint, EndpointType::interrupt, identity::controller_interface}}} {}

void Device::poll() {
  Event event;
  for (int i = 0; i < events_per_poll && port_.next_event(event); ++i) handle(event);
  const std::uint32_t now_periods = link_.poses.newest_periods();
  link_.driver.pass_time(now_periods);
  if (link_.driver.has_expired(now_periods)) {
    link_.driver.end();
    driver_gone();
  }
  if (force_must_fall_) let_force_fall();
  if (held_command_) pass_on_held_command();
  if (configured() && !suspended_) {
    send_pose();
    send_scope();
  }
}

void Device::handle(const Event& event) {
  const auto data = std::span<const std::byte>(event.data).first(event.length);
  switch (event.kind) {
    case Event::Kind::reset: bus_reset(); break;
    case Event::Kind::suspend:
      suspended_ = true;
      forget(endpoints_[hid_in]);
      forget(endpoints_[controller_in]);
      host_gone();
      break;
    case Event::Kind::resume: suspended_ = false; break;
    case Event::Kind::setup: control_.setup(data); break;
    case Event::Kind::received:
      if (event.endpoint == 0) {
        control_.received(data);
      } else if (event.endpoint == identity::hid_out_endpoint && configured()) {
        take_report(data);
      }
      break;
    case Event::Kind::sent:
      if (event.endpoint == 0) {
        control_.sent();
        leaves_for_update_ = detach_requested_;
      } else if (Endpoint* endpoint = find_endpoint(0x80u | event.endpoint)) {
        endpoint->busy = false;
        if (endpoint == &endpoints_[hid_in]) note_pose_sent();
        if (endpoint == &endpoints_[controller_in]) controller_taken_at_ = pose_sequence_;
      }
      break;
  }
}

void Device::bus_reset() {
  for (Endpoint& endpoint : endpoints_) endpoint.busy = endpoint.halted = false;
  scope_frame_open_ = scope_wants_end_ = false;
  configuration_ = 0;  // set before host_gone(), because only endpoint 0 is open
  idle_rates_ = {};
  detach_requested_ = detach_was_refused_ = false;
  link_.update_requested.store(false);
  suspended_ = false;
  control_.reset();
  host_gone();
}

void Device::host_gone() {
  link_.commands.host_gone();
  link_.request_results.forget();
  link_.driver.end();
  link_.program.driver_gone();
  if (held_command_) {
    held_command_.reset();
    if (configured()) port_.receive(identity::hid_out_endpoint);
  }
  link_.scope.select({}, 0);
}

bool Device::check_claim(std::uint32_t claim) {
  const bool may = note_heard(claim);
  if (!may) link_.driver.count_refusal();
  return may;
}

bool Device::note_heard(std::uint32_t claim) {
  if (link_.driver.is_held_by(claim)) link_.driver.renew(link_.poses.newest_periods());
  return link_.driver.permits(claim);
}

void Device::driver_gone() {
  link_.program.driver_gone();
  force_must_fall_ = !link_.driver.is_held() && force_is_on();
}

void Device::let_force_fall() {
  force_must_fall_ =
      !link_.commands.push({.command = protocol::Command::disable_force, .token = link_.commands.last_token()});
}

void Device::start_endpoints() {
  poses_replaced_ = 0;
  spare_waits_ = false;
  for (Endpoint& endpoint : endpoints_) {
    endpoint.busy = endpoint.halted = false;
    port_.open(endpoint.address, endpoint.type);
  }
  scope_frame_open_ = scope_wants_end_ = false;
  if (!held_command_) port_.receive(identity::hid_out_endpoint);
}

void Device::stop_endpoints() {
  for (Endpoint& endpoint : endpoints_) {
    endpoint.busy = endpoint.halted = false;
    port_.close(endpoint.address);
  }
  scope_frame_open_ = scope_wants_end_ = false;
}

Device::Endpoint* Device::find_endpoint(std::uint16_t address) {
  if (!configured()) return nullptr;
  for (Endpoint& endpoint : endpoints_)
    if (endpoint.address == address) return &endpoint;
  return nullptr;
}

void Device::restart(Endpoint& endpoint) {
  port_.clear_stall(endpoint.address);
  const bool was_busy = endpoint.busy;
  endpoint.busy = endpoint.halted = false;
  if (&endpoint == &endpoints_[hid_out]) {
    if (!held_command_) port_.receive(endpoint.address);
  } else if (&endpoint == &endpoints_[scope_in]) {
    scope_frame_open_ = scope_wants_end_ = false;  // the frame restarts from its first byte
  } else if (was_busy) {
    if (&endpoint == &endpoints_[hid_in])
      send(endpoint, pose_);
    else
      send(endpoint, controller_);
  }
}

// The host may poll directly after each start of frame. Near the end of each bus frame, the device loads the newest
// pose. The device loads a spare pose `spare_pose_lead_s` earlier. If the main loop is late, the host reads the spare
// pose.
void Device::send_pose() {
  const std::optional<BusFrame> bus_frame = port_.bus_frame();
  Endpoint& endpoint = endpoints_[hid_in];
  if (!bus_frame || endpoint.halted) return;
  const std::uint32_t sequence = bus_frame->count + 1;
  const bool replaces_spare = pose_sequence_ == sequence;
  if (replaces_spare && !spare_waits_) return;
  const std::optional<std::uint32_t> sampled_cycles = link_.poses.newest_cycles();
  if (!sampled_cycles) return;
  const auto age_cycles = static_cast<std::int32_t>(bus_frame->now_cycles - *sampled_cycles);
  const auto to_frame_cycles =
      static_cast<std::int32_t>(bus_frame->begin_cycles + bus_frame->length_cycles - bus_frame->now_cycles);
  const std::int32_t beyond_lead_cycles =
      age_cycles + to_frame_cycles -
      (period_cycles_ + static_cast<std::int32_t>(link_.poses.longest_cycles()) + pose_loading_cycles_);
  if (beyond_lead_cycles > spare_pose_lead_cycles_) return;
  const bool is_spare = beyond_lead_cycles > 0;
  const std::int32_t undisturbed_cycles = std::min(period_cycles_ - age_cycles, to_frame_cycles);
  if (replaces_spare && (is_spare || undisturbed_cycles < pose_replacing_cycles_)) return;
  if (endpoint.busy) {
    endpoint.busy = false;
    if (!port_.cancel(endpoint.address))
      note_pose_sent();
    else if (!replaces_spare)
      ++poses_replaced_;
    if (replaces_spare && !spare_waits_) return;
  }
  if (!(is_spare ? link_.poses.read(pose_) : link_.poses.read_for_report(pose_))) return;
  pose_.sequence = pose_sequence_ = sequence;
  pose_.driver_parity = driver_parity();
  spare_waits_ = is_spare;
  send(endpoint, pose_);
  if (!is_spare) offer_controller_report();
}

// When the next poll is due, the device replaces the controller report in every bus frame. The controller report is as
// recent as the pose.
void Device::offer_controller_report() {
  Endpoint& endpoint = endpoints_[controller_in];
  const bool is_early = pose_sequence_ - controller_taken_at_ < identity::controller_interval_ms;
  if (endpoint.halted || (is_early && endpoint.busy)) return;
  forget(endpoint);
  controller_ = controller_report(pose_);
  send(endpoint, controller_);
}

void Device::note_pose_sent() {
  if (poses_replaced_ < replaced_unheard) poses_dropped_ += poses_replaced_;
  poses_replaced_ = 0;
  if (!std::exchange(spare_waits_, false)) return;
  link_.poses.note_sent();
  offer_controller_report();
}

void Device::forget(Endpoint& endpoint) {
  if (!endpoint.busy) return;
  port_.cancel(endpoint.address);
  endpoint.busy = false;
}

void Device::send_scope() {
  Endpoint& endpoint = endpoints_[scope_in];
  if (endpoint.busy || endpoint.halted) return;
  if (scope_wants_end_) {
    scope_wants_end_ = false;
    endpoint.busy = true;
    port_.send(endpoint.address, {});
    return;
  }
  if (scope_frame_open_) {
    link_.scope.release();
    scope_frame_open_ = false;
  }
  const std::span<const std::byte> scope_frame = link_.scope.oldest_frame();
  if (scope_frame.empty()) return;
  scope_frame_open_ = true;
  scope_wants_end_ = scope_frame.size() % packet_size_maximum == 0;
  endpoint.busy = true;
  port_.send(endpoint.address, scope_frame);
}

void Device::take_report(std::span<const std::byte> report) {
  const auto is = [report](protocol::ReportId id) {
    return !report.empty() && report[0] == static_cast<std::byte>(id);
  };
  if (is(protocol::ReportId::force) || is(protocol::ReportId::local_model)) {
    is(protocol::ReportId::force) ? take_force(report) : take_local_model(report);
    port_.receive(identity::hid_out_endpoint);
    return;
  }
  held_command_ = read_command(report);
  pass_on_held_command();
}

void Device::take_force(std::span<const std::byte> report) {
  const std::uint32_t claim = link::claim_of_force(report);
  const bool is_of_driver = check_claim(claim) && link_.driver.is_held_by(claim);
  if (link_.program.accept_force(report, is_of_driver, pose_sequence_)) link_.commands.note_sign_of_life();
}

void Device::take_local_model(std::span<const std::byte> report) {
  const std::uint32_t claim = link::claim_of_local_model(report);
  const bool is_of_driver = check_claim(claim) && link_.driver.is_held_by(claim);
  if (link_.program.accept_local_model(report, is_of_driver, pose_sequence_)) link_.commands.note_sign_of_life();
}

void Device::take_shapes(std::span<const std::byte> report) {
  const std::uint32_t claim = link::claim_of_shapes(report);
  const bool is_of_driver = check_claim(claim) && link_.driver.is_held_by(claim);
  link_.request_results.note_shapes(link::ticket_of_shapes(report), is_of_driver
                                                                        ? link_.program.accept_shapes(report)
                                                                        : protocol::RequestResult::not_the_driver);
}

std::optional<protocol::CommandReport> Device::read_command(std::span<const std::byte> report) {
  const auto command = link::whole_command(report);
  if (!command || link::is_valid(*command)) return command;
  link_.request_results.note_dropped(*command, protocol::RequestResult::malformed);
  return std::nullopt;
}

bool Device::pass_on(const std::optional<protocol::CommandReport>& command) {
  if (!command) return true;
  if (protocol::needs_claim(command->command) && !check_claim(command->claim)) {
    link_.request_results.note_dropped(*command, protocol::RequestResult::not_the_driver);
    return true;
  }
  // A heartbeat is ignored if another program is the driver.
  if (command->command == protocol::Command::heartbeat && !note_heard(command->claim)) return true;
  if (!link_.commands.has_room()) return false;
  // The signals are selected first, because the queued command causes the acknowledgment.
  if (command->command == protocol::Command::select_signals) link_.scope.select(command->selection, command->token);
  // The command is counted first, because the queued command causes the acknowledgment.
  if (command->command == protocol::Command::store_parameters || command->command == protocol::Command::factory_reset)
    link_.stored.ask(command->command, may_store());
  const bool was_pushed = link_.commands.push(*command);
  if (was_pushed) link_.request_results.note_queued(*command);
  return was_pushed;
}

void Device::pass_on_held_command() {
  if (!pass_on(held_command_)) return;
  held_command_.reset();
  port_.receive(identity::hid_out_endpoint);
}

}  // namespace inkwell::usb
