#include "boards/virtual/usb/shared_port.hpp"

#include <algorithm>
#include <utility>

namespace inkwell::virtual_board {

namespace {

constexpr std::uint8_t set_configuration_request = 9;
constexpr std::uint8_t to_device = 0x00;

std::uint8_t request_byte(const Urb& urb, std::size_t index) { return std::to_integer<std::uint8_t>(urb.setup[index]); }

bool sets_configuration(const Urb& urb) {
  return urb.endpoint == 0 && request_byte(urb, 0) == to_device && request_byte(urb, 1) == set_configuration_request;
}

}  // namespace

SharedPort::SharedPort(Scheduler& scheduler, BusDevice& device, Client& client, double host_clock_ppm)
    : client_(client), port_(scheduler, device, *this, host_clock_ppm) {}

void SharedPort::enumerated(const DeviceDescription& description) {
  description_ = description;
  client_.enumerated(description);
}

void SharedPort::detached() {
  owners_.clear();
  shared_on_bus_.clear();
  sessions_.clear();
  bulk_owner_.reset();
  configuration_.reset();
  client_.detached();
}

void SharedPort::import(std::uint32_t session) {
  if (sessions_.empty()) {
    configuration_.reset();
    port_.import();
  }
  sessions_.emplace(session, Session{});
}

void SharedPort::release(std::uint32_t session) {
  sessions_.erase(session);
  if (bulk_owner_ == session) bulk_owner_.reset();
  if (sessions_.empty()) {
    owners_.clear();
    shared_on_bus_.clear();
    port_.release();
    return;
  }
  std::erase_if(owners_, [&](const auto& entry) {
    if (entry.second.session != session) return false;
    port_.unlink(entry.first);
    return true;
  });
  stop_useless_polling();
}

void SharedPort::submit(std::uint32_t session, Urb&& urb) {
  if (!sessions_.contains(session)) return;  // the device was removed before this transfer arrived
  if (is_of_type(urb, TransferType::interrupt) && urb.in) {
    const std::uint8_t endpoint = urb.endpoint;
    sessions_[session].interrupt_requests[endpoint].push_back(std::move(urb));
    keep_polling(endpoint);
  } else if (is_of_type(urb, TransferType::bulk) && bulk_owner_.value_or(session) != session) {
    client_.completed(session, std::move(urb), transfer_status::busy);
  } else if (sets_configuration(urb) && configuration_ && sessions_.size() > 1) {
    client_.completed(session, std::move(urb), transfer_status::success);
  } else {
    const bool is_bulk = is_of_type(urb, TransferType::bulk);
    if (is_bulk) bulk_owner_ = session;
    pass_on({session, urb.sequence, is_bulk}, std::move(urb));
  }
}

void SharedPort::pass_on(const Owner& owner, Urb&& urb) {
  urb.sequence = ++sequence_;
  owners_.emplace(urb.sequence, owner);
  port_.submit(std::move(urb));
}

void SharedPort::keep_polling(std::uint8_t endpoint) {
  if (shared_on_bus_.contains(endpoint)) return;
  Urb urb;
  for (auto& [number, session] : sessions_)
    if (const auto& requests = session.interrupt_requests[endpoint]; !requests.empty())
      urb.length = std::max(urb.length, requests.front().length);
  if (urb.length == 0) return;  // no program has a request
  urb.sequence = ++sequence_;
  urb.endpoint = endpoint;
  urb.in = true;
  shared_on_bus_[endpoint] = urb.sequence;
  port_.submit(std::move(urb));
}

void SharedPort::stop_useless_polling() {
  std::erase_if(shared_on_bus_, [this](const auto& entry) {
    const auto polls = [&](auto& session) { return !session.second.interrupt_requests[entry.first].empty(); };
    if (std::ranges::any_of(sessions_, polls)) return false;
    port_.unlink(entry.second);
    return true;
  });
}

std::optional<Urb> SharedPort::unlink(std::uint32_t session, std::uint32_t sequence) {
  const auto program = sessions_.find(session);
  if (program == sessions_.end()) return std::nullopt;
  for (auto& [endpoint, requests] : program->second.interrupt_requests) {
    const auto found = std::ranges::find(requests, sequence, &Urb::sequence);
    if (found == requests.end()) continue;
    Urb taken = std::move(*found);
    requests.erase(found);
    stop_useless_polling();
    return taken;
  }
  const auto owner = std::ranges::find_if(
      owners_, [&](const auto& entry) { return entry.second.session == session && entry.second.sequence == sequence; });
  if (owner == owners_.end()) return std::nullopt;
  std::optional<Urb> taken = port_.unlink(owner->first);
  if (!taken) return std::nullopt;
  owners_.erase(owner);
  taken->sequence = sequence;
  const auto is_bulk = [](const auto& entry) { return entry.second.is_bulk; };
  if (bulk_owner_ == session && std::ranges::none_of(owners_, is_bulk)) bulk_owner_.reset();
  return taken;
}

void SharedPort::completed(Urb&& urb, std::int32_t status) {
  if (const auto shared = shared_on_bus_.find(urb.endpoint);
      shared != shared_on_bus_.end() && shared->second == urb.sequence) {
    shared_on_bus_.erase(shared);
    hand_out(urb, status);
    keep_polling(urb.endpoint);
    return;
  }
  const auto found = owners_.find(urb.sequence);
  if (found == owners_.end()) return;
  const Owner owner = found->second;
  owners_.erase(found);
  urb.sequence = owner.sequence;
  if (sets_configuration(urb) && status == transfer_status::success) configuration_ = request_byte(urb, 2);
  client_.completed(owner.session, std::move(urb), status);
}

void SharedPort::hand_out(const Urb& report, std::int32_t status) {
  for (auto& [number, session] : sessions_) {
    auto& requests = session.interrupt_requests[report.endpoint];
    if (requests.empty()) continue;  // this program misses the report
    Urb urb = std::move(requests.front());
    requests.pop_front();
    const bool fits = report.data.size() <= urb.length;
    urb.data.assign(report.data.begin(), report.data.begin() + (fits ? report.data.size() : urb.length));
    client_.completed(number, std::move(urb), fits ? status : transfer_status::overflow);
  }
}

bool SharedPort::is_of_type(const Urb& urb, TransferType type) const {
  if (urb.endpoint == 0 || !urb.packets.empty()) return false;
  const std::uint8_t address = urb.endpoint | (urb.in ? 0x80u : 0u);
  for (const ConfigurationDescription& configuration : description_.configurations)
    if (configuration.value == configuration_)
      for (const EndpointDescription& endpoint : configuration.endpoints)
        if (endpoint.address == address) return endpoint.type == type;
  return false;
}

}  // namespace inkwell::virtual_board
