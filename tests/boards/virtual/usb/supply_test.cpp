// Tests the flashed firmware during a slow supply loss, with the documented brown-out level and with the level of a new
// chip.
#include <doctest/doctest.h>

#include "boards/omni_driver/facts.hpp"

#include "tests/boards/virtual/usb/firmware_on_bus.hpp"

namespace inkwell::virtual_usb_test {
namespace {

using virtual_board::PinLevel;
using virtual_board::ResetCause;

std::uint32_t brown_outs(const FirmwareOnBus& bus) {
  return bus.chip.counters().resets[static_cast<std::size_t>(ResetCause::brown_out)];
}

PinLevel level(const FirmwareOnBus& bus, board::Pin pin) { return bus.chip.pin_output(pin.port, pin.number); }

}  // namespace

TEST_CASE("brown-out level 3 holds the chip in reset before the flash is misread, and lets it start again") {
  FirmwareOnBus bus(flashed_image(), 0.0, {.brown_out_level = 3});
  bus.connect();
  bus.chip.clear_counters();
  bus.chip.set_supply_V(2.85);
  bus.run_for(0.01);
  CHECK(brown_outs(bus) == 0);
  bus.chip.set_supply_V(2.8);
  CHECK(brown_outs(bus) == 1);
  const auto instructions = bus.chip.counters().instructions;
  bus.run_for(0.1);
  CHECK(bus.chip.counters().instructions == instructions);
  CHECK(bus.core.attachment() == 0);
  CHECK(level(bus, board::omni_driver.bridge_enable) == PinLevel::floating);
  bus.chip.set_supply_V(2.85);  // between the falling and the rising threshold
  bus.run_for(0.1);
  CHECK(bus.chip.counters().instructions == instructions);
  bus.chip.reset();  // the reset button has no effect
  bus.run_for(0.1);
  CHECK(bus.chip.counters().instructions == instructions);
  bus.chip.set_supply_V(3.3);
  for (int i = 0; i < 1000 && !bus.port.enumerated(); ++i) bus.run_for(0.001);
  CHECK(bus.port.enumerated());
  CHECK(bus.violations().empty());
}

TEST_CASE("without a brown-out level the flash is misread at 168 MHz below 2.7 V") {
  FirmwareOnBus bus(flashed_image());
  bus.connect();
  bus.chip.set_supply_V(2.7);
  bus.run_for(0.01);
  CHECK(bus.violations().empty());
  bus.chip.set_supply_V(2.6);
  REQUIRE(bus.chip.violations().size() == 1);
  CHECK(bus.chip.violations().front().rule == virtual_board::Rule::flash_wait_states);
}

}  // namespace inkwell::virtual_usb_test
