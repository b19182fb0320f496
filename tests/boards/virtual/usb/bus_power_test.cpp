// The flashed firmware and the cable's supply: USB 2.0, section 7.1.5.
#include <doctest/doctest.h>

#include "firmware_on_bus.hpp"

namespace inkwell::virtual_usb_test {
namespace {

bool enumerates(FirmwareOnBus& bus) {
  for (int i = 0; i < 1000 && !bus.port.enumerated(); ++i) bus.run_for(0.001);
  return bus.port.enumerated();
}

}  // namespace

TEST_CASE("D+ is pulled up only while the cable brings VBUS") {
  FirmwareOnBus bus(flashed_image());
  bus.connect();
  bus.plug(false);
  bus.run_for(0.001);
  CHECK(bus.core.attachment() == 0);
  bus.run_for(0.05);
  CHECK(bus.core.attachment() == 0);
  bus.plug(true);
  CHECK(enumerates(bus));

  bus.plug(false);
  bus.chip.reset();
  bus.run_for(0.2);
  CHECK(bus.core.attachment() == 0);
  bus.plug(true);
  CHECK(enumerates(bus));
  CHECK(bus.violations().empty());
}

}  // namespace inkwell::virtual_usb_test
