#include "transports.hpp"

#include <fmt/format.h>

#include <protocol/usb_identity.hpp>

namespace inkwell::device {

std::unique_ptr<Transport> open_transport(const Endpoint& endpoint) {
  return endpoint.kind == Endpoint::Kind::usb ? open_usb_transport(endpoint) : open_usbip_transport(endpoint);
}

std::string permission_message(const std::string& path) {
  // uaccess is handed out by a rule numbered 73, so the file must sort before it. SUBSYSTEMS also looks at the
  // parents, so the one line covers the USB device and the hidraw node below it.
  return fmt::format(
      "You may not open the arm at {}. Write this line into /etc/udev/rules.d/70-inkwell.rules, then plug the arm in "
      "again: SUBSYSTEMS==\"usb\", ATTRS{{idVendor}}==\"{:04x}\", ATTRS{{idProduct}}==\"{:04x}\", TAG+=\"uaccess\"",
      path, protocol::usb::vendor_id, protocol::usb::product_id);
}

}  // namespace inkwell::device
