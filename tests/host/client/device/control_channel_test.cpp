// Tests the request that switches a connected arm from the firmware to the boot loader.
#include <doctest/doctest.h>

#include <libusb-1.0/libusb.h>

#include "host/client/device/control_channel.hpp"
#include "tests/failure.hpp"

#include "tests/host/client/device/fake_usb.hpp"

using namespace inkwell;
using namespace inkwell::tests;

namespace {

/// Answer to DFU_GETSTATUS (DFU 1.1, section 6.1.2) without waiting time and text.
Bytes update_status(unsigned status, unsigned state) {
  Bytes answer(6);
  answer[0] = static_cast<std::byte>(status);
  answer[4] = static_cast<std::byte>(state);
  return answer;
}

constexpr unsigned no_error = 0, vendor_error = 0x0B;
constexpr unsigned application_idle = 0, application_detach = 1;

}  // namespace

TEST_CASE("a firmware that leaves has accepted the request, whether it still answers or not") {
  FakeUsb usb;
  auto& arm = usb.add_arm("A");
  SUBCASE("it answers that it leaves") { arm.update_status = update_status(no_error, application_detach); }
  SUBCASE("it has left") { arm.leaves_at_detach = true; }
  SUBCASE("it refuses to answer") {}
  SUBCASE("its answer is empty") { arm.update_status = Bytes(1); }
  CHECK_NOTHROW(device::detach_firmware(arm.endpoint()));
  CHECK(arm.detaches == 1);
  CHECK(usb.open_things == 0);
}

TEST_CASE("detach_firmware raises an error for a refusal by status or by stall") {
  FakeUsb usb;
  auto& arm = usb.add_arm("A");
  SUBCASE("status") { arm.update_status = update_status(vendor_error, application_idle); }
  SUBCASE("stall") { arm.stalls_detach = true; }
  CHECK(contains(message_of<device::Stalled>([&] { device::detach_firmware(arm.endpoint()); }), "refused"));
  CHECK(usb.open_things == 0);
}

TEST_CASE("a boot loader without a driver is no missing boot loader: the error names the remedy") {
  FakeUsb usb;
  auto& loader = usb.add_arm("A");
  loader.vendor_id = 0x0483;
  loader.product_id = 0xDF11;
  device::Address address;
  CHECK(device::find_boot_loaders(address).size() == 1);
  for (const int code : {LIBUSB_ERROR_NOT_SUPPORTED, LIBUSB_ERROR_NOT_FOUND}) {
    loader.open_result = code;
    CHECK(contains(message_of<device::NoPermission>([&] { device::find_boot_loaders(address); }), "no driver"));
    CHECK(
        contains(message_of<device::NoPermission>([&] { device::open_boot_loader(loader.endpoint()); }), "no driver"));
  }
  loader.open_result = 0;
  loader.claim_result = LIBUSB_ERROR_NOT_FOUND;
  CHECK(contains(message_of<device::NoPermission>([&] { device::open_boot_loader(loader.endpoint()); }), "no driver"));
  CHECK(usb.open_things == 0);
}
