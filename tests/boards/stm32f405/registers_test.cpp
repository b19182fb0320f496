// Tests that the registers agree with their register maps.
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <iterator>
#include <set>
#include <string>
#include <string_view>

#include "boards/stm32f405/peripherals/exti.hpp"
#include "tests/boards/stm32f405/chip_fixture.hpp"

using namespace inkwell::virtual_board;
using namespace inkwell::virtual_board::test;

namespace {

std::uint32_t read_register(Chip& chip, std::uint32_t address) {
  std::array<std::uint8_t, 4> bytes;
  REQUIRE(chip.debug_port().read(address, bytes));
  std::uint32_t value;
  std::memcpy(&value, bytes.data(), sizeof value);
  return value;
}

void write_register(Chip& chip, std::uint32_t address, std::uint32_t value) {
  std::array<std::uint8_t, 4> bytes;
  std::memcpy(bytes.data(), &value, sizeof value);
  REQUIRE(chip.debug_port().write(address, bytes));
}

struct Deviation {
  std::string_view peripheral, name;  ///< an empty peripheral means all peripherals
  std::string_view reason;
};

/// Registers with another value than the reset value of their map.
constexpr Deviation deviations[] = {
    {"", "IDR", "levels at the pins"},
    {"", "ARR", "largest count of the timer"},
    {"DWT", "CTRL", "0 while DEMCR.TRCENA is 0"},
    {"FPU_CPACR", "CPACR", "written by the start-up code"},
    {"PWR", "CSR", "the voltage regulator is always ready"},
    {"RCC", "AHB1ENR", "written by the test firmware"},
    {"RCC", "AHB2ENR", "written by the test firmware"},
    {"RCC", "APB1ENR", "written by the test firmware"},
    {"RCC", "APB2ENR", "written by the test firmware"},
    {"RTC", "DR", "the model derives the weekday from the date"},
    {"RTC", "SSR", "the model counts down from PRER.PREDIV_S"},
    {"SCB", "ICSR", "RETTOBASE is set in thread mode"},
    {"SCB", "VTOR", "written by the start-up code"},
};

const Deviation* deviation_of(std::string_view peripheral, std::string_view name) {
  const auto found = std::ranges::find_if(deviations, [&](const Deviation& it) {
    return it.name == name && (it.peripheral.empty() || it.peripheral == peripheral);
  });
  return found == std::end(deviations) ? nullptr : found;
}

}  // namespace

TEST_SUITE("virtual chip: registers") {
  TEST_CASE("after a reset, each register has the reset value of its map") {
    ChipUnderTest test("all_clocks", Mode::fast);
    test.run_for(100e-6);
    REQUIRE(test.result(0) == finished);
    unsigned registers = 0;
    std::set<const Deviation*> differing;
    for (const RegisterMap& map : test.chip.register_maps())
      for (const MapEntry& entry : map.entries)
        for (unsigned i = 0; entry.is_register != 0 && i < entry.count; ++i, ++registers) {
          const std::uint32_t value = read_register(test.chip, map.base + entry.first_position + entry.stride * i);
          const std::string name = map.name + "." + entry.name.data();
          CAPTURE(name);
          CAPTURE(i);
          const Deviation* deviation = deviation_of(map.name, entry.name.data());
          if (deviation == nullptr)
            CHECK(value == entry.reset_value);
          else if (value != entry.reset_value)
            differing.insert(deviation);
        }
    CHECK(registers > 900);
    for (const Deviation& listed : deviations) {
      CAPTURE(std::string(listed.name));
      CHECK(differing.contains(&listed));
    }
  }

  TEST_CASE("SYSCFG stores only the writable fields of its map") {
    ChipUnderTest test("all_clocks", Mode::fast);
    test.run_for(100e-6);
    constexpr std::uint32_t base = 0x4001'3800;
    write_register(test.chip, base + syscfg_registers.exticr1, 0xFFFF'FFFF);
    CHECK(read_register(test.chip, base + syscfg_registers.exticr1) == 0xFFFF);
    write_register(test.chip, base + syscfg_registers.cmpcr, 0xFFFF'FFFF);
    CHECK(read_register(test.chip, base + syscfg_registers.cmpcr) == 1);
  }
}
