#include <virtual_usb/virtual_usb.hpp>

#include <vector>

#include <virtual_usb/root_port.hpp>
#include "usbip_server.hpp"

namespace inkwell::virtual_board {

struct VirtualUsb::Implementation final : RootPort::Client {
  Implementation(Scheduler& scheduler, InterruptController& interrupts, UnmodelledLog& log, std::uint16_t tcp_port)
      : core(scheduler, interrupts, log), root_port(scheduler, core, *this), server(tcp_port) {}

  void between_transactions() override {
    server.take(orders);
    for (UsbIpServer::Order& order : orders) carry_out(std::move(order));
    orders.clear();
  }

  void carry_out(UsbIpServer::Order&& order) {
    using Kind = UsbIpServer::Order::Kind;
    switch (order.kind) {
      case Kind::import:
        session = order.session;
        root_port.import();
        break;
      case Kind::release: root_port.release(); break;
      case Kind::submit: root_port.submit(std::move(order.urb)); break;
      case Kind::unlink: {
        const bool found = root_port.unlink(order.unlink_sequence);
        server.answer({UsbIpServer::Result::Kind::unlinked, session, std::move(order.urb),
                       found ? transfer_status::unlinked : transfer_status::success, order.unlink_sequence});
        break;
      }
    }
  }

  void enumerated(const DeviceDescription& description) override { server.offer(description); }
  void detached() override { server.withdraw(); }
  void completed(Urb&& urb, std::int32_t status) override {
    server.answer({UsbIpServer::Result::Kind::submitted, session, std::move(urb), status});
  }

  OtgFsDevice core;
  RootPort root_port;
  std::uint32_t session = 0;
  std::vector<UsbIpServer::Order> orders;
  UsbIpServer server;
};

VirtualUsb::VirtualUsb(Scheduler& scheduler, InterruptController& interrupts, UnmodelledLog& log, std::uint16_t port)
    : implementation_(std::make_unique<Implementation>(scheduler, interrupts, log, port)) {
  connect();
}
VirtualUsb::~VirtualUsb() = default;

OtgFsDevice& VirtualUsb::core() { return implementation_->core; }
std::uint16_t VirtualUsb::port() const { return implementation_->server.port(); }
void VirtualUsb::connect() { implementation_->root_port.plug(true); }
void VirtualUsb::disconnect() { implementation_->root_port.plug(false); }
bool VirtualUsb::connected() const { return implementation_->root_port.plugged(); }
bool VirtualUsb::enumerated() const { return implementation_->root_port.enumerated(); }
bool VirtualUsb::imported() const { return implementation_->root_port.imported(); }

}  // namespace inkwell::virtual_board
