#include <virtual_usb/virtual_usb.hpp>

#include <chrono>
#include <iostream>
#include <optional>
#include <utility>
#include <vector>

#include <virtual_usb/host_pace.hpp>
#include <virtual_usb/root_port.hpp>
#include "usbip_server.hpp"

namespace inkwell::virtual_board {

namespace {
using Clock = std::chrono::steady_clock;
constexpr std::chrono::milliseconds attention{50};  // how soon a board that waits for its host notices its end
}  // namespace

struct VirtualUsb::Implementation final : RootPort::Client {
  Implementation(const ChipConnections& chip, std::uint16_t tcp_port, double host_clock_ppm,
                 std::function<void()> on_request, std::function<bool()> ends)
      : core(chip),
        root_port(chip.scheduler, core, *this, host_clock_ppm),
        is_ending(std::move(ends)),
        server(tcp_port, std::move(on_request)) {}

  void between_transactions() override { wait_while(&HostPace::is_starved); }

  void serve() {
    server.take(orders);
    for (UsbIpServer::Order& order : orders) carry_out(std::move(order));
    orders.clear();
  }

  void wait_while(bool (HostPace::*condition)() const) {
    if (!(pace.*condition)()) return;
    bool has_told = false;
    std::optional<bool> was_limited;
    Clock::time_point late_at;
    while ((pace.*condition)() && !is_ending()) {
      const bool is_limited = !pace.is_waited_for_without_limit();
      if (was_limited != is_limited) late_at = Clock::now() + HostPace::patience;
      was_limited = is_limited;
      if (server.wait_for_order(Clock::now() + attention)) {
        serve();
      } else if (Clock::now() >= late_at && is_limited) {
        std::cerr << "USB/IP: the client does not ask for more; board time no longer waits for it.\n";
        pace.lose_patience();
      } else if (Clock::now() >= late_at && !has_told) {
        std::cerr << "USB/IP: the client has stopped; board time waits until it goes on or is gone.\n";
        has_told = true;
      }
    }
  }

  void carry_out(UsbIpServer::Order&& order) {
    using Kind = UsbIpServer::Order::Kind;
    switch (order.kind) {
      case Kind::import:
        session = order.session;
        pace.start_anew();
        root_port.import();
        break;
      case Kind::release:
        pace.start_anew();
        root_port.release();
        break;
      case Kind::submit:
        pace.submitted(order.urb);
        root_port.submit(std::move(order.urb));
        break;
      case Kind::unlink: {
        const auto found = root_port.unlink(order.unlink_sequence);
        if (found)
          pace.unlinked(*found);
        else
          pace.unlinked_too_late(order.unlink_sequence);
        server.answer({UsbIpServer::Result::Kind::unlinked, session, std::move(order.urb),
                       found ? transfer_status::unlinked : transfer_status::success, order.unlink_sequence});
        break;
      }
    }
  }

  void enumerated(const DeviceDescription& description) override { server.offer(description); }
  void detached() override {
    pace.start_anew();
    server.withdraw();
  }
  void completed(Urb&& urb, std::int32_t status) override {
    pace.completed(urb, status);
    server.answer({UsbIpServer::Result::Kind::submitted, session, std::move(urb), status});
  }

  OtgFsDevice core;
  RootPort root_port;
  HostPace pace;
  std::function<bool()> is_ending;
  std::uint32_t session = 0;
  std::vector<UsbIpServer::Order> orders;
  UsbIpServer server;
};

VirtualUsb::VirtualUsb(const ChipConnections& chip, std::uint16_t port, double host_clock_ppm,
                       std::function<void()> on_request, std::function<bool()> is_ending)
    : implementation_(
          std::make_unique<Implementation>(chip, port, host_clock_ppm, std::move(on_request), std::move(is_ending))) {
  connect();
}
VirtualUsb::~VirtualUsb() = default;

OtgFsDevice& VirtualUsb::core() { return implementation_->core; }
std::uint16_t VirtualUsb::port() const { return implementation_->server.port(); }
void VirtualUsb::serve() { implementation_->serve(); }
void VirtualUsb::settle() {
  implementation_->server.exchange_all();
  implementation_->serve();
  implementation_->wait_while(&HostPace::is_owed);
}
bool VirtualUsb::is_asked() const { return implementation_->pace.is_asked(); }
void VirtualUsb::connect() { implementation_->root_port.plug(true); }
void VirtualUsb::disconnect() { implementation_->root_port.plug(false); }
bool VirtualUsb::connected() const { return implementation_->root_port.plugged(); }
bool VirtualUsb::enumerated() const { return implementation_->root_port.enumerated(); }
bool VirtualUsb::imported() const { return implementation_->root_port.imported(); }

}  // namespace inkwell::virtual_board
