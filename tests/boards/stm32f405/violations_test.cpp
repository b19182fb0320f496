// The test firmware violates one rule, and the virtual chip reports the violation.
#include <doctest/doctest.h>

#include "boards/stm32f405/otg_fs/otg_fs_device.hpp"

#include "tests/boards/stm32f405/chip_fixture.hpp"

using namespace inkwell::virtual_board;
using namespace inkwell::virtual_board::test;

namespace {

struct Case {
  unsigned number;  ///< number in firmware/rules.cc
  Rule rule;
};
constexpr Case cases[] = {
    {1, Rule::float_unit_off},
    {2, Rule::voltage_scale},
    {3, Rule::usb_clock},
    {4, Rule::usb_pins},
    {5, Rule::usb_transceiver},
    {6, Rule::usb_core_reset},
    {7, Rule::usb_mode_wait},
    {8, Rule::usb_turnaround},
    {9, Rule::usb_speed},
    {10, Rule::converter_too_fast},
    {11, Rule::clock_off},
    {12, Rule::analog_pin_mode},
    {13, Rule::converter_not_stable},
    {14, Rule::usb_mode},
    {15, Rule::usb_fifo_packets},
    {16, Rule::flash_wait_states},
    {17, Rule::pclk1_too_fast},
    {18, Rule::pll_input},
    {19, Rule::clock_fresh},
    {20, Rule::ccm_clock_off},
    {21, Rule::timer_locked},
    {22, Rule::watchdog_busy},
    {23, Rule::usb_disturbed},
    {24, Rule::option_bytes_locked},
    {25, Rule::narrow_register_write},
    {26, Rule::region_undefined},
    {27, Rule::region_number},
    {28, Rule::region_number},
    {29, Rule::narrow_core_write},
    {30, Rule::stream_flags_left},
    {31, Rule::usart_pin},
    {32, Rule::usart_divider},
    {33, Rule::reference_off},
    {34, Rule::reference_hurried},
    {35, Rule::reference_hurried},
    {36, Rule::core_reset},
};

/// The host resets the bus when a device connects.
struct Planted {
  explicit Planted(unsigned violation, Mode mode = Mode::exact) : test("rules", mode), core(test.chip.connections()) {
    test.breaks_rules = violation != 0;
    test.circuit.voltages = {{{'C', 0}, 1.0}, {{'C', 1}, 1.0}, {{'C', 2}, 1.0}};
    test.chip.add_peripheral(OtgFsDevice::base, OtgFsDevice::size, "OTG_FS", core);
    for (unsigned pin = 0; pin < 8; ++pin)
      test.chip.input_pins().drive('D', pin, (violation >> pin & 1) != 0 ? PinLevel::high : PinLevel::low);
    core.set_bus_power(true);
    test.chip.reset();
    test.run_for(0.11);
    if (core.attachment() == 0) return;
    core.begin_reset();
    core.end_reset();
    core.setup(0, 0, std::array<std::byte, 8>{});
  }
  std::uint32_t converted(unsigned converter) const { return test.result(1 + converter); }
  bool host_is_answered() {
    std::array<std::byte, full_speed_packet_maximum> packet{};
    return core.attachment() != 0 && core.in(0, 0, packet).handshake != Handshake::nothing;
  }

  ChipUnderTest test;
  OtgFsDevice core;
};

constexpr std::uint32_t one_volt = 1241;
constexpr std::uint32_t reference = 1477;  // 1.19 V

}  // namespace

TEST_SUITE("virtual chip: rules of silicon") {
  TEST_CASE("a firmware that keeps all the rules breaks none") {
    for (const Mode mode : {Mode::exact, Mode::fast}) {
      Planted none(0, mode);
      CHECK(none.test.result(0) == finished);
      CHECK(none.test.chip.violations().empty());
      for (unsigned converter = 0; converter < 3; ++converter) CHECK(none.converted(converter) == one_volt);
      CHECK(none.test.result(8) == reference);
      CHECK(none.host_is_answered());
    }
  }

  TEST_CASE("each violation is reported without any other violation") {
    for (const Case& planted : cases) {
      CAPTURE(info(planted.rule).name);
      const Planted faulty(planted.number);
      CHECK(faulty.test.has_broken(planted.rule));
      for (const Violation& violation : faulty.test.chip.violations()) {
        CAPTURE(sentence(violation));
        CHECK(violation.rule == planted.rule);
      }
    }
  }

  TEST_CASE("fast mode detects the same violations, except those that depend on the distance between two accesses") {
    for (const Case& planted : cases) {
      if (planted.rule == Rule::clock_fresh) continue;
      CAPTURE(info(planted.rule).name);
      CHECK(Planted(planted.number, Mode::fast).test.has_broken(planted.rule));
    }
  }

  TEST_CASE("a violation names the code address, its first time and how often it happened") {
    const Planted faulty(11);
    const auto& violations = faulty.test.chip.violations();
    REQUIRE(violations.size() == 2);
    CHECK(violations[0].where == "ADC2");
    CHECK(violations[1].where == "ADC3");
    CHECK(violations[0].count == 5);
    CHECK(violations[0].code_address >= 0x0800'0000);
    CHECK(violations[0].code_address < 0x0810'0000);
    CHECK(violations[0].first > 0);
    CHECK(sentence(violations[0]).find("ADC2") != std::string::npos);
  }

  TEST_CASE("a violation is reported, and has its effect on the chip") {
    SUBCASE("no FPU: a UsageFault, escalated") {
      for (const Mode mode : {Mode::exact, Mode::fast}) {
        const Planted faulty(1, mode);
        CHECK(faulty.test.result(5) == 1u << 19);  // NOCP
        CHECK(faulty.test.result(0) != finished);
      }
    }
    SUBCASE("no clock for CCM: a BusFault") {
      const Planted faulty(20);
      CHECK((faulty.test.result(5) & 0xFF00) != 0);
      CHECK(faulty.test.result(0) != finished);
    }
    SUBCASE("with too few wait states, the core reads wrong instructions and locks up") {
      for (const Mode mode : {Mode::exact, Mode::fast}) {
        Planted faulty(16, mode);
        CHECK(faulty.test.result(0) != finished);
        CHECK(faulty.test.chip.run_until(faulty.test.chip.now()) == Stop::locked_up);
      }
    }
    SUBCASE("a converter without its clock reads 0, the others work") {
      const Planted faulty(11);
      CHECK(faulty.converted(0) == one_volt);
      CHECK(faulty.converted(1) == 0);
      CHECK(faulty.converted(2) == 0);
    }
    SUBCASE("a converter that is too fast, not stable or at a digital pin returns wrong values") {
      for (const unsigned number : {10u, 12u, 13u}) CHECK(Planted(number).converted(0) != one_volt);
    }
    SUBCASE("an internal reference that is off or hurried gives nonsense") {
      CHECK(Planted(33).test.result(8) == 0);
      for (const unsigned number : {34u, 35u}) CHECK(Planted(number).test.result(8) != reference);
    }
    SUBCASE("the host detects no device without pins and receives no answer without 48 MHz") {
      CHECK_FALSE(Planted(3).host_is_answered());
      CHECK_FALSE(Planted(4).host_is_answered());
    }
    SUBCASE("option bytes change only when they are unlocked") {
      CHECK(Planted(0).test.result(7) == 0x0FFF'AAE1);
      CHECK(Planted(24).test.result(7) == 0x0FFF'AAED);
    }
    SUBCASE("a byte that is written to a register of an APB is repeated") {
      CHECK(Planted(25).test.result(6) == 0x0303);
    }
    SUBCASE("a register that LOCK protects does not change") { CHECK(Planted(21).test.result(4) == 0); }
  }
}
