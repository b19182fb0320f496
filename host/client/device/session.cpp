#include "host/client/device/session.hpp"

#include <utility>

#include "host/client/device/session_threads.hpp"

namespace inkwell::device {

Session::Session(std::function<std::optional<Endpoint>()> find)
    : implementation_(std::make_unique<Implementation>(std::move(find))) {}
Session::~Session() = default;

SessionStatus Session::status() const {
  const std::lock_guard lock(implementation_->mutex);
  return implementation_->state;
}

std::optional<Pose> Session::newest_pose() const {
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

void Session::take_over() {
  const std::lock_guard lock(implementation_->mutex);
  implementation_->requests.take_over = true;
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
  implementation_->requests.parameters.add(changes);
}

void Session::restore_default_parameters() {
  const std::lock_guard lock(implementation_->mutex);
  implementation_->requests.parameters = {.restore_defaults = true};  // the defaults overwrite all queued changes
}

void Session::store_parameters() {
  const std::lock_guard lock(implementation_->mutex);
  implementation_->queue_store_task(StoreTask::store);
}

void Session::factory_reset() {
  const std::lock_guard lock(implementation_->mutex);
  implementation_->queue_store_task(StoreTask::forget);
}

std::optional<Reconnection> Session::reconnection() const {
  const std::lock_guard lock(implementation_->mutex);
  return implementation_->newest_reconnection;
}

std::optional<std::string> Session::refusal() const {
  const std::lock_guard lock(implementation_->mutex);
  return implementation_->newest_refusal;
}

std::vector<Event> Session::take_events() {
  const std::lock_guard lock(implementation_->mutex);
  const EventLog log = std::exchange(implementation_->events, {});
  std::vector<Event> events;
  for (std::uint64_t number = log.begin(); number < log.end(); ++number) events.push_back(log[number]);
  return events;
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

void Session::on_pose(std::function<void(Device&, const DrivenPose&)> receive) {
  const std::lock_guard lock(implementation_->mutex);
  implementation_->new_receive_pose = std::move(receive);
}

}  // namespace inkwell::device
