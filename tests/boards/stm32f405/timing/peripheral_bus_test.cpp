#include <doctest/doctest.h>

#include "boards/stm32f405/timing/peripheral_bus.hpp"

namespace inkwell::virtual_board {
namespace {

constexpr Costs likely{Pricing::likely}, conservative{Pricing::conservative};
constexpr std::uint32_t on_apb1 = 0x4000'0000, on_apb2 = 0x4001'0000, on_ahb1 = 0x4002'0000, in_core = 0xE000'E100;

PeripheralBus bus_at(std::uint32_t hclk_Hz, const Costs& costs = likely) {
  PeripheralBus bus(costs);
  bus.set_clocks(hclk_Hz, hclk_Hz / 4, hclk_Hz / 2);
  return bus;
}

TEST_CASE("a read crosses to the bus, waits for its edge and takes two of its cycles") {
  auto bus = bus_at(168'000'000);
  CHECK(bus.access(on_apb1, false, 1000) == 1 + 0 + 2 * 4);
  CHECK(bus.access(on_apb1, false, 2001) == 1 + 3 + 2 * 4);
  CHECK(bus.access(on_apb2, false, 3001) == 1 + 1 + 2 * 2);
  CHECK(bus.access(on_ahb1, false, 4000) == 1);
  CHECK(bus.access(in_core, false, 5000) == 1);
}

TEST_CASE("a write does not delay the core, but delays the next access to the same bridge") {
  auto bus = bus_at(168'000'000);
  CHECK(bus.access(on_apb1, true, 1000) == 0);
  CHECK(bus.access(on_apb2, true, 1000) == 0);
  CHECK(bus.access(on_apb1, true, 1004) == 5);
  auto other = bus_at(168'000'000);
  CHECK(other.access(on_apb1, true, 1000) == 0);
  CHECK(other.access(on_apb1, false, 1004) == 5 + (1 + 3 + 2 * 4));
}

TEST_CASE("the conservative pricing always just misses an edge") {
  auto bus = bus_at(168'000'000, conservative);
  CHECK(bus.access(on_apb1, false, 1000) == 2 + 3 + 2 * 4);
}

TEST_CASE("frequencies of a crystal that is off keep their ratio") {
  // 168 MHz plus 95 ppm is 168'015'960 Hz. After rounding, four times the APB1 clock can exceed HCLK.
  for (const std::uint32_t hclk_Hz : {168'015'960u, 168'015'961u, 168'015'963u, 167'984'037u}) {
    CAPTURE(hclk_Hz);
    auto bus = bus_at(hclk_Hz);
    CHECK(bus.access(on_apb1, false, 1001) == 1 + 3 + 2 * 4);
    PeripheralBus above(likely);
    above.set_clocks(hclk_Hz, hclk_Hz / 4 + 1, hclk_Hz / 2 + 1);
    CHECK(above.access(on_apb1, false, 1001) == 1 + 3 + 2 * 4);
  }
}

TEST_CASE("an access to a bus with a stopped clock does not wait for this clock") {
  PeripheralBus bus(likely);
  bus.set_clocks(168'000'000, 0, 84'000'000);
  CHECK(bus.access(on_apb1, false, 1001) == 1 + 2);
}

}  // namespace
}  // namespace inkwell::virtual_board
