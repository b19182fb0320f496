#include "host/client/device/transports.hpp"

#include <fmt/format.h>

namespace inkwell::device {
namespace {

constexpr char udev_rule[] =
#include "udev_rule.inc"
    ;

class OneThread final : public LockStep {
 public:
  bool is_in_step() const override { return false; }
  bool wait(const std::function<bool()>&, std::chrono::milliseconds) override { return false; }
};

}  // namespace

LockStep& one_thread() {
  static OneThread one_thread;
  return one_thread;
}

std::unique_ptr<Transport> open_transport(const Endpoint& endpoint) {
  return endpoint.kind == Endpoint::Kind::usb ? open_usb_transport(endpoint) : open_usbip_transport(endpoint);
}

std::string permission_message(const std::string& path) {
  // The file number must be lower than 73, because the system's rule file 73 applies uaccess.
  return fmt::format(
      "You have no permission to open the arm at {}. Install Inkwell's package, which contains the udev rule, and plug "
      "the arm in again. Without the package, first write this line into /etc/udev/rules.d/60-inkwell.rules: {}",
      path, udev_rule);
}

}  // namespace inkwell::device
