#include <virtual_usb/virtual_usb.hpp>

#include <chrono>
#include <iostream>
#include <utility>
#include <vector>

#include <virtual_usb/host_pace.hpp>
#include <virtual_usb/root_port.hpp>
#include "usbip_server.hpp"

namespace inkwell::virtual_board {

struct VirtualUsb::Implementation final : RootPort::Client {
  Implementation(const ChipConnections& chip, std::uint16_t tcp_port, double host_clock_ppm,
                 std::function<void()> on_request)
      : core(chip), root_port(chip.scheduler, core, *this, host_clock_ppm), server(tcp_port, std::move(on_request)) {}

  void between_transactions() override { wait_while(&HostPace::is_starved); }

  void serve() {
    server.take(orders);
    for (UsbIpServer::Order& order : orders) carry_out(std::move(order));
    orders.clear();
  }

  void wait_while(bool (HostPace::*condition)() const) {
    const auto give_up_at = std::chrono::steady_clock::now() + HostPace::patience;
    while ((pace.*condition)()) {
      if (!server.wait_for_order(give_up_at)) {
        std::cerr << "USB/IP: the client does not ask for more; board time no longer waits for it.\n";
        pace.lose_patience();
      }
      serve();
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
        if (found) pace.unlinked(*found);
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
  std::uint32_t session = 0;
  std::vector<UsbIpServer::Order> orders;
  UsbIpServer server;
};

VirtualUsb::VirtualUsb(const ChipConnections& chip, std::uint16_t port, double host_clock_ppm,
                       std::function<void()> on_request)
    : implementation_(std::make_unique<Implementation>(chip, port, host_clock_ppm, std::move(on_request))) {
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
