#include <doctest/doctest.h>

#include "host/client/device/address.hpp"
#include "host/companion/window/device_desk/device_desk.hpp"
#include "tests/failure.hpp"
#include "tests/host/client/device/fake_usb.hpp"
#include "tests/host/client/device/fake_usbip_server.hpp"

using namespace inkwell;
using namespace inkwell::tests;

TEST_CASE("with several arms, the desk asks the user and connects to the chosen arm") {
  FakeUsb usb;
  usb.add_arm("A");
  usb.add_arm("B");
  window::DeviceDesk desk([] { return device::find_arms({}); }, "");
  REQUIRE(eventually([&] { return desk.refresh().must_choose && !desk.view().status.message.empty(); }));
  CHECK(contains(desk.view().status.message, "2 arms are plugged in"));
  CHECK(desk.view().listed.size() == 2);
  CHECK_FALSE(desk.view().connected());
  desk.choose("B");
  desk.follow_choice();
  CHECK(desk.wanted_serial_number() == "B");
  // No arm answers in this test, so the desk shows an error instead of a question.
  REQUIRE(eventually([&] { return !desk.refresh().status.message.empty(); }));
  CHECK_FALSE(desk.view().must_choose);
}
