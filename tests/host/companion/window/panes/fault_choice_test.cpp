#include "host/companion/window/panes/fault_choice.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "boards/omni_driver/facts.hpp"
#include "tests/failure.hpp"

using namespace inkwell;
using namespace inkwell::tests;
using namespace inkwell::window;
using protocol::InjectedFault;

namespace {

std::vector<std::string> names_found(std::string_view search) {
  std::vector<std::string> names;
  for (const auto& row : protocol::injection_table)
    if (is_found(row, search)) names.emplace_back(row.name);
  return names;
}

}  // namespace

TEST_CASE("a search finds each of its words in the name, the part or the help text") {
  using Names = std::vector<std::string>;
  CHECK(names_found("").size() == protocol::injection_table.size());
  CHECK(names_found("  ").size() == protocol::injection_table.size());
  CHECK(names_found("encoder_stuck") == Names{"encoder_stuck"});
  CHECK(names_found("Stuck ENCODER") == Names{"encoder_stuck"});
  CHECK(names_found("lost counts") == Names{"encoder_lost_counts"});
  CHECK(names_found("memory") == Names{"ram_bit", "flash_bit"});
  CHECK(names_found("debug probe") == Names{"core_halted"});
  CHECK(names_found("2 us") == Names{"wire_spikes"});
  CHECK(names_found("encoder nothing").empty());
}

TEST_CASE("obstacle states the reason unless faults can be injected into a virtual board with a control port") {
  using device::Connection;
  const device::SessionStatus none{};
  device::SessionStatus real{.connection = Connection::connected}, simulation = real;
  simulation.is_simulation = true;
  CHECK(obstacle(simulation, true).empty());
  CHECK(obstacle(none, true).empty());  // a virtual board with an unplugged cable still exists
  CHECK(contains(obstacle(real, true), "real device"));
  CHECK(contains(obstacle(real, false), "real device"));
  CHECK(contains(obstacle(simulation, false), "`--control`"));
  CHECK(contains(obstacle(none, false), "`inkwell --virtual`"));
}

TEST_CASE("every part has a title") {
  for (const auto& row : protocol::injection_table) {
    CAPTURE(row.name);
    CHECK_FALSE(title_of(row.part).empty());
  }
}

TEST_CASE("the wires are those of the board's facts, without the cable's") {
  const auto names = wires();
  CHECK(names.size() == std::size(board::omni_driver.pin_uses()) - 2);
  CHECK(std::ranges::count(names, "encoders[1].a") == 1);
  CHECK(std::ranges::count(names, "usb_plus") == 0);
}

TEST_CASE("request_of returns the entered values, and empty fields leave the defaults of the board") {
  const auto request = request_of({InjectedFault::shunt_offset, "2", "0.25", "1.5", "1e-3"});
  CHECK(request.fault == "shunt_offset");
  CHECK(request.of == "2");
  CHECK(request.amount == 0.25);
  CHECK(request.after_s == 1.5);
  CHECK(request.for_s == 0.001);
  const auto bare = request_of({InjectedFault::shunt_offset, "2", "", "", ""});
  CHECK_FALSE(bare.amount);
  CHECK(bare.after_s == 0.0);
  CHECK_FALSE(bare.for_s);
}

TEST_CASE("of another fault's fields nothing is asked for") {
  const auto request = request_of({InjectedFault::supply_cut, "2", "7", "", ""});
  CHECK(request.of.empty());
  CHECK_FALSE(request.amount);
}

TEST_CASE("the error for a field that is not a number names the field") {
  const auto text_of = [](const TypedInjection& typed) {
    return message_of<device::Error>([&] { request_of(typed); });
  };
  CHECK(contains(text_of({InjectedFault::supply_sag, "", "much", "", ""}), "`much` is not a number. Enter the amount"));
  CHECK(contains(text_of({InjectedFault::supply_sag, "", "1,5", "", ""}), "without commas"));
  CHECK(contains(text_of({InjectedFault::supply_sag, "", "inf", "", ""}), "is not a number"));
  CHECK(contains(text_of({InjectedFault::supply_sag, "", "", "1 s", ""}), "the start delay"));
  CHECK(contains(text_of({InjectedFault::supply_sag, "", "", "", "x"}), "the duration"));
}

TEST_CASE("a fault is shown with its location and its amount") {
  const auto text_of = [](const char* fault, const char* of, std::optional<double> amount) {
    return location_and_amount({.number = 1, .fault = fault, .of = of, .amount = amount, .at_s = 0, .has_come = true});
  };
  CHECK(text_of("shunt_offset", "2", 0.5) == "motor 2, 0.5 A");
  CHECK(text_of("leg_high", "3B", {}) == "leg 3B");
  CHECK(text_of("wire_open", "encoders[1].a", {}) == "encoders[1].a");
  CHECK(text_of("exception_late", "34", 4200) == "exception 34, 4200 cycles");
  CHECK(text_of("adc_stopped", "1", {}) == "converter 1");
  CHECK(text_of("supply_sag", "", 9) == "9 V");
  CHECK(text_of("encoder_lost_counts", "1", 0.01) == "motor 1, 0.01");
  CHECK(text_of("supply_cut", "", {}).empty());
  CHECK(text_of("of_another_version", "7", 3) == "7, 3");
}

TEST_CASE("duration_text returns milliseconds or seconds") {
  CHECK(duration_text(0.00005) == "0.05 ms");
  CHECK(duration_text(0.0124) == "12.4 ms");
  CHECK(duration_text(1.352) == "1.35 s");
}

TEST_CASE("names of faults are shown in words, and the search accepts both forms") {
  CHECK(window::readable_name("wire_open") == "Wire open");
  CHECK(window::with_readable_name("motor_hot 400 K is outside 0 to 300.") == "Motor hot 400 K is outside 0 to 300.");
  CHECK(window::with_readable_name("Another sentence.") == "Another sentence.");
  const auto& row = protocol::info(protocol::InjectedFault::wire_open);
  CHECK(window::is_found(row, "wire_open"));
  CHECK(window::is_found(row, "wire open"));
}

TEST_CASE("a fault with a location cannot be injected before the location is chosen") {
  const auto missing = [](protocol::InjectedFault fault, const char* of) {
    return window::missing_input({fault, of, {}, {}, {}});
  };
  CHECK(missing(protocol::InjectedFault::wire_open, "") == "Choose a wire first.");
  CHECK(missing(protocol::InjectedFault::wire_open, "PA0") == "");
  CHECK(missing(protocol::InjectedFault::supply_sag, "") == "");
}
