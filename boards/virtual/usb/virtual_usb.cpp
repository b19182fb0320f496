#include "boards/virtual/usb/virtual_usb.hpp"

#include <algorithm>
#include <chrono>
#include <functional>
#include <iostream>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "boards/virtual/usb/client_name.hpp"
#include "boards/virtual/usb/host_pace.hpp"

#include "boards/virtual/usb/shared_port.hpp"
#include "boards/virtual/usb/usbip_server.hpp"

namespace inkwell::virtual_board {

namespace {
using Clock = std::chrono::steady_clock;
constexpr std::chrono::milliseconds attention{50};  // time for a waiting board to notice its end
}  // namespace

struct VirtualUsb::Implementation final : SharedPort::Client {
  Implementation(const ChipConnections& chip, const local::SocketAddress& where, double host_clock_ppm,
                 std::function<void()> on_request, std::function<bool()> ends)
      : connector(chip),
        port(chip.scheduler, connector, *this, host_clock_ppm),
        is_ending(std::move(ends)),
        server(where, std::move(on_request)) {}

  void between_transactions() override {
    wait_while(is_in_lock_step() ? &HostPace::is_stream_starved : &HostPace::is_starved, go_on_while_late);
  }

  bool is_in_lock_step() const { return on_stop != nullptr; }
  bool lets_time_pass() const {
    return std::ranges::all_of(paces, [](const auto& entry) { return entry.second.waits_for_board(); });
  }

  using Condition = bool (HostPace::*)() const;

  bool any(Condition condition) const {
    return std::ranges::any_of(paces, [&](const auto& entry) { return (entry.second.*condition)(); });
  }
  /// Returns true if the wait for this condition has a time limit.
  bool is_limited(Condition condition) const {
    if (is_in_lock_step()) return false;
    if (has_limit || paces.size() > 1) return any(condition);
    return std::ranges::any_of(paces, [&](const auto& entry) {
      return (entry.second.*condition)() && !entry.second.is_waited_for_without_limit();
    });
  }
  /// Returns the names of all programs for which `is_waited_for` is true.
  template <class Waited>
  std::vector<std::string> names(Waited is_waited_for) const {
    std::vector<std::string> names;
    for (const auto& [session, pace] : paces)
      if (std::invoke(is_waited_for, pace)) names.push_back(client_name(clients.at(session)));
    return names;
  }

  void serve() {
    server.take(orders);
    for (UsbIpServer::Order& order : orders) carry_out(std::move(order));
    if (!orders.empty()) late.clear();
    orders.clear();
  }

  /// Waits as long as the condition is true for any program. A wait without time limit continues only while `goes_on`
  /// returns true.
  void wait_while(Condition condition, const std::function<bool()>& goes_on) {
    if (!any(condition)) return;
    std::optional<bool> was_limited;
    Clock::time_point late_at;
    while (any(condition) && !is_ending()) {
      const bool limited = is_limited(condition);
      if (was_limited != limited) late_at = Clock::now() + HostPace::patience;
      was_limited = limited;
      if (!late.empty() && !limited && !goes_on()) return;
      if (server.wait_for_order(Clock::now() + attention)) {
        serve();
      } else if (Clock::now() >= late_at && limited) {
        for (const auto& name : names(condition))
          std::cerr << "USB/IP: " << name
                    << " sends no further requests; board time no longer waits for this program.\n";
        for (auto& [session, pace] : paces)
          if ((pace.*condition)()) pace.lose_patience();
      } else if (Clock::now() >= late_at && late.empty()) {
        late = names(condition);
        for (const auto& name : late)
          std::cerr << "USB/IP: " << name << " has stopped; board time waits until the program continues or exits.\n";
      }
    }
  }

  void carry_out(UsbIpServer::Order&& order) {
    using Kind = UsbIpServer::Order::Kind;
    switch (order.kind) {
      case Kind::import:
        paces[order.session] = {};
        clients[order.session] = order.client;
        port.import(order.session);
        break;
      case Kind::release:
        paces.erase(order.session);
        clients.erase(order.session);
        port.release(order.session);
        break;
      case Kind::submit:
        paces[order.session].submitted(order.urb);
        port.submit(order.session, std::move(order.urb));
        break;
      case Kind::unlink: {
        const auto found = port.unlink(order.session, order.unlink_sequence);
        if (found)
          paces[order.session].unlinked(*found);
        else
          paces[order.session].unlinked_too_late(order.unlink_sequence);
        server.answer({UsbIpServer::Result::Kind::unlinked, order.session, std::move(order.urb),
                       found ? transfer_status::unlinked : transfer_status::success, order.unlink_sequence});
        break;
      }
    }
  }

  void enumerated(const DeviceDescription& description) override { server.offer(description); }
  void detached() override {
    for (auto& [session, pace] : paces) pace.restart();
    server.withdraw();
  }
  void completed(std::uint32_t session, Urb&& urb, std::int32_t status) override {
    paces[session].completed(urb, status);
    if (is_in_lock_step() && !lets_time_pass()) on_stop();
    server.answer({UsbIpServer::Result::Kind::submitted, session, std::move(urb), status});
  }

  Connector connector;
  SharedPort port;
  std::map<std::uint32_t, HostPace> paces;  ///< of each program that has imported the device
  std::map<std::uint32_t, Peer> clients;
  bool has_limit = false;         ///< every wait has a time limit
  std::vector<std::string> late;  ///< programs with an unlimited wait that has exceeded HostPace::patience
  std::function<bool()> go_on_while_late = [] { return true; };
  std::function<bool()> is_ending;
  std::function<void()> on_stop;  ///< in lock step only
  std::vector<UsbIpServer::Order> orders;
  UsbIpServer server;
};

VirtualUsb::VirtualUsb(const ChipConnections& chip, const local::SocketAddress& where, double host_clock_ppm,
                       std::function<void()> on_request, std::function<bool()> is_ending)
    : implementation_(
          std::make_unique<Implementation>(chip, where, host_clock_ppm, std::move(on_request), std::move(is_ending))) {
  connect();
}
VirtualUsb::~VirtualUsb() = default;

Connector& VirtualUsb::connector() { return implementation_->connector; }
const local::SocketAddress& VirtualUsb::address() const { return implementation_->server.address(); }
std::uint16_t VirtualUsb::port() const { return address().port; }
void VirtualUsb::serve() { implementation_->serve(); }
void VirtualUsb::settle() {
  implementation_->server.exchange_all();
  implementation_->serve();
  const auto owed = implementation_->is_in_lock_step() ? &HostPace::is_stream_owed : &HostPace::is_owed;
  implementation_->wait_while(owed, [] { return false; });
}
void VirtualUsb::limit_waiting() { implementation_->has_limit = true; }
void VirtualUsb::on_late_host(std::function<bool()> goes_on) { implementation_->go_on_while_late = std::move(goes_on); }
std::vector<std::string> VirtualUsb::late_hosts() const {
  if (!implementation_->is_in_lock_step() || !implementation_->late.empty()) return implementation_->late;
  return implementation_->names([](const HostPace& pace) { return !pace.waits_for_board(); });
}
bool VirtualUsb::has_control_transfer() const { return implementation_->any(&HostPace::has_control_transfer); }
void VirtualUsb::keep_in_lock_step(std::function<void()> on_stop) { implementation_->on_stop = std::move(on_stop); }
bool VirtualUsb::lets_time_pass() const { return implementation_->lets_time_pass(); }
void VirtualUsb::connect() { implementation_->port.plug(true); }
void VirtualUsb::disconnect() { implementation_->port.plug(false); }
void VirtualUsb::set_host_polling(bool polls) { implementation_->port.set_host_polling(polls); }
bool VirtualUsb::connected() const { return implementation_->port.plugged(); }
bool VirtualUsb::enumerated() const { return implementation_->port.enumerated(); }
bool VirtualUsb::imported() const { return implementation_->port.imported(); }

}  // namespace inkwell::virtual_board
