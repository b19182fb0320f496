// Tests the validation of control socket requests, without a board.
#include "boards/virtual/program/requests.hpp"

#include <string>

#include <doctest/doctest.h>
#include "boards/virtual/plant/truth.hpp"
#include "tests/failure.hpp"

using namespace inkwell::virtual_board;
using inkwell::tests::contains;
using inkwell::tests::message_of;

namespace {

std::string refusal_of(const std::string& line) {
  return message_of<Refused>([&] { read_request(line); });
}

}  // namespace

TEST_CASE("a request selects a command by name and accepts only the keys of this command") {
  const Request request = read_request(R"({"command": "run", "for_s": 0.5})");
  CHECK(request.info->command == Command::run);
  CHECK(run_time_s(request.values) == 0.5);
  CHECK(contains(refusal_of("[]"), "one JSON object in one line"));
  CHECK(contains(refusal_of("{\"command\""), "one JSON object in one line"));
  CHECK(contains(refusal_of("{}"), "\"command\" is missing"));
  CHECK(contains(refusal_of(R"({"command": "jump"})"), "there is no command \"jump\"; use one of these: status, "));
  CHECK(contains(refusal_of(R"({"command": "usb", "on": 1})"),
                 "the command \"usb\" has no key \"on\"; its keys are: connected"));
}

TEST_CASE("every command is in the table and in the help once") {
  const std::string help = explain_commands();
  CHECK(command_table().size() == static_cast<std::size_t>(Command::trace) + 1);
  std::size_t row = 0;
  for (const CommandInfo& info : command_table()) {
    CAPTURE(info.name);
    CHECK(static_cast<std::size_t>(info.command) == row++);
    CHECK(read_request("{\"command\":\"" + std::string(info.name) + "\"}").info == &info);
    CHECK(contains(help, "  " + std::string(info.name) + " "));
  }
}

TEST_CASE("a missing required value and a value outside its bounds are refused") {
  using nlohmann::json;
  CHECK(message_of<Refused>([] {
          run_time_s(json{{"for_s", -1}});
        }) == "\"for_s\": the value -1 is outside 0 to 1000000");
  CHECK(message_of<Refused>([] { glitch_time_s(json::object()); }) == "\"for_s\" is missing; it must be a number");
  CHECK_FALSE(flash_operation(json::object()));
  CHECK(flash_operation(json{{"at_flash_operation", 7}}) == 7);
  CHECK(contains(message_of<Refused>([] { flash_operation(json{{"at_flash_operation", 0}}); }), "outside 1 to"));
  CHECK(contains(message_of<Refused>([] { supply_voltage_V(json{{"voltage_V", 36.1}}); }), "outside 0 to 36"));
  CHECK(contains(message_of<Refused>([] {
                   gimbal_angles_rad(json{{"angles_rad", {0, 0, 21}}});
                 }),
                 "outside -20 to 20"));
  CHECK(meter_action(json{{"action", "read"}}) == MeterAction::read);
  CHECK(message_of<Refused>([] {
          meter_action(json{{"action", "stop"}});
        }) == "\"action\" must be \"start\" or \"read\"");
  CHECK(trace_action(json{{"action", "stop"}}) == TraceAction::stop);
  CHECK(trace_rows(json::object()) == 10'000);
  CHECK(trace_rows(json{{"maximum", Trace::rows_maximum}}) == 100'000);  // the remaining rows follow in the next answer
}

TEST_CASE("a name that is no text is not written out, however deep its lists are") {
  constexpr std::size_t deep = 500'000;  // the longest line that the socket accepts
  CHECK(contains(refusal_of(R"({"command": )" + std::string(deep, '[') + std::string(deep, ']') + "}"),
                 "must be the name of a command"));
}
