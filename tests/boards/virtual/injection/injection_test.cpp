#include "boards/virtual/injection/injection.hpp"
#include "boards/omni_driver/facts.hpp"

#include <string>

#include <doctest/doctest.h>

using namespace inkwell::virtual_board;
using inkwell::protocol::InjectedFault;

namespace {

namespace board = inkwell::board;

std::string refusal_of(const std::string& text) {
  try {
    parse_injection(text, board::omni_driver);
  } catch (const InvalidInjection& error) {
    return error.what();
  }
  return "accepted";
}

bool refuses(const std::string& text, const std::string& because) {
  const std::string message = refusal_of(text);
  CAPTURE(text);
  CAPTURE(message);
  CHECK(message.find(because) != std::string::npos);
  return message.find(because) != std::string::npos;
}

}  // namespace

TEST_CASE("a fault is written with its position, amount, time and duration") {
  const auto lost = parse_injection("encoder_lost_counts:2=0.05@1.5+0.2", board::omni_driver);
  CHECK(lost.fault == InjectedFault::encoder_lost_counts);
  CHECK(lost.number == 1);
  CHECK(lost.of == "2");
  CHECK(lost.amount == 0.05);
  CHECK(lost.after_s == 1.5);
  CHECK(lost.for_s == 0.2);

  const auto stuck = parse_injection("encoder_stuck:3", board::omni_driver);
  CHECK(stuck.number == 2);
  CHECK(stuck.after_s == 0.0);
  CHECK_FALSE(stuck.for_s);
  CHECK(parse_injection("supply_sag", board::omni_driver).amount == 10.0);
  CHECK(parse_injection("supply_sag+0.5", board::omni_driver).for_s == 0.5);
  CHECK(parse_injection("adc_stopped:2", board::omni_driver).number == 2);
  CHECK(parse_injection("exception_late:34=8400", board::omni_driver).number == 34);

  const auto leg = parse_injection("leg_slow:3B=0.000002", board::omni_driver);
  CHECK(leg.number == 2);
  CHECK(leg.leg == 1);
  CHECK(parse_injection("leg_high:1A", board::omni_driver).leg == 0);
  CHECK(parse_injection("leg_high:2B", board::omni_driver).number == 1);
}

TEST_CASE("a wire is selected by its pin or its function, and is named after its function if there is one") {
  CHECK(parse_injection("wire_open:PB4", board::omni_driver).of == "encoders[1].a");
  CHECK(parse_injection("wire_open:PB4", board::omni_driver).wires[0] == PinName{'B', 4});
  CHECK(parse_injection("wire_low:bridge_enable", board::omni_driver).wires[0] == PinName{'B', 1});
  CHECK(parse_injection("wire_low:PD2", board::omni_driver).of == "PD2");
  const auto shorted = parse_injection("wires_shorted:PA0+encoders[0].b@0.5+1", board::omni_driver);
  CHECK(shorted.of == "encoders[0].a+encoders[0].b");
  CHECK(shorted.wires[1] == PinName{'A', 1});
  CHECK(shorted.after_s == 0.5);
  CHECK(shorted.for_s == 1.0);
}

TEST_CASE("a memory fault has an address, or the seed selects the address") {
  CHECK(parse_injection("ram_bit:0x20000100=3", board::omni_driver).address == 0x2000'0100u);
  CHECK(parse_injection("ram_bit:536871168", board::omni_driver).address == 0x2000'0100u);
  CHECK_FALSE(parse_injection("flash_bit", board::omni_driver).address);
  CHECK(parse_injection("flash_bit", board::omni_driver).amount == -1.0);
}

TEST_CASE("an invalid fault is refused with a sentence that states the mistake or the valid values") {
  CHECK(refuses("encoder_stick:1", "there is no fault \"encoder_stick\"; use one of these: wire_open, "));
  CHECK(refuses("", "there is no fault \"\""));
  CHECK(refuses("encoder_stuck", "encoder_stuck needs a location; add the motor: 1, 2 or 3"));
  CHECK(refuses("encoder_stuck:4", "\"4\" is not a valid motor; use one of these: 1, 2, 3"));
  CHECK(refuses("encoder_stuck:-1", "is not a valid motor"));
  CHECK(refuses("encoder_stuck:1x", "is not a valid motor"));
  CHECK(refuses("encoder_stuck:1=3", "encoder_stuck has no amount"));
  CHECK(refuses("shunt_offset:1=11", "shunt_offset 11 A is outside -10 to 10"));
  CHECK(refuses("ram_bit=9", "ram_bit 9 is outside -1 to 7"));  // without a unit and without a space for it
  CHECK(refuses("shunt_offset:1=much", "\"much\" is not a number; a number is required for the amount"));
  CHECK(refuses("shunt_offset:1=nan", "is not a number"));
  CHECK(refuses("supply_cut:1", "supply_cut has no location; omit \"1\""));
  CHECK(refuses("supply_cut@-1", "the delay is -1 s"));
  CHECK(refuses("supply_cut@2e6", "outside 0 to"));
  CHECK(refuses("supply_cut+9e9", "the duration is"));
  CHECK(refuses("leg_high:4A", "use one of these: 1A, 1B, 2A, 2B, 3A, 3B"));
  CHECK(refuses("leg_high:1C", "use one of these: 1A"));
  CHECK(refuses("wire_open:PZ1", "is not a wire; use a pin"));
  CHECK(refuses("wire_open:PA16", "is not a wire"));
  CHECK(refuses("wire_open:usb_plus", "use usb_cut to unplug the cable"));
  CHECK(refuses("wires_shorted:PA0", "needs two wires"));
  CHECK(refuses("wires_shorted:PA0+encoders[0].a", "two different wires"));
  CHECK(refuses("exception_lost:98", "from 2 to 97"));
  CHECK(refuses("adc_stopped:0", "is not a valid converter"));
  CHECK(refuses("ram_bit:here", "is not an address; use a number such as 0x20000100"));
  CHECK(refuses("ram_bit:0x100000000", "is not an address"));
  CHECK(refuses("ram_bit=8", "outside -1 to 7"));
}

TEST_CASE("a script has one fault a line, and the line that is wrong is named") {
  const auto faults =
      parse_injections("# a bad day\nsupply_sag=9@1+0.1  # weak\n\n  motor_open:2@2\r\n", board::omni_driver);
  REQUIRE(faults.size() == 2);
  CHECK(faults[0].fault == InjectedFault::supply_sag);
  CHECK(faults[1].fault == InjectedFault::motor_open);
  CHECK(parse_injections("", board::omni_driver).empty());
  CHECK_THROWS_WITH_AS(parse_injections("motor_open:1\n\nmotor_open:7\n", board::omni_driver),
                       "line 3: \"7\" is not a valid motor; use one of these: 1, 2, 3", InvalidInjection);
}

TEST_CASE("the help has a line for each fault") {
  const std::string help = explain_injections();
  for (const auto& row : inkwell::protocol::injection_table) {
    CAPTURE(row.name);
    const std::string text = row.help;
    CHECK(help.find("  " + std::string(row.name)) != std::string::npos);
    CHECK(help.find(text.substr(0, text.find('{'))) != std::string::npos);
  }
  CHECK(help.find("Number of spikes of 2 us per second on a digital input") != std::string::npos);
  CHECK(help.find('{') == std::string::npos);
}
