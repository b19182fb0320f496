// What clients of the control socket ask for, and what of it is refused, without a board.
#include <program/requests.hpp>

#include <string>

#include <doctest/doctest.h>
#include <failure.hpp>

using namespace inkwell::virtual_board;
using inkwell::tests::contains;
using inkwell::tests::message_of;

namespace {

std::string refusal_of(const std::string& line) {
  return message_of<Refused>([&] { read_request(line); });
}

}  // namespace

TEST_CASE("a command is known by its name, with keys of its own") {
  const Request request = read_request(R"({"command": "run", "for_s": 0.5})");
  CHECK(request.info->command == Command::run);
  CHECK(number(request.values, "for_s", 0.0, 1.0) == 0.5);
  CHECK(contains(refusal_of("[]"), "one JSON object in one line"));
  CHECK(contains(refusal_of("{\"command\""), "one JSON object in one line"));
  CHECK(contains(refusal_of("{}"), "\"command\" is missing"));
  CHECK(contains(refusal_of(R"({"command": "jump"})"), "there is no command \"jump\"; known are status, "));
  CHECK(contains(refusal_of(R"({"command": "usb", "on": 1})"), "does not know the key \"on\"; it knows connected"));
}

TEST_CASE("every command is in the table once, and in the help") {
  const std::string help = explain_commands();
  for (const CommandInfo& info : command_table()) {
    CAPTURE(info.name);
    CHECK(read_request("{\"command\":\"" + std::string(info.name) + "\"}").info == &info);
    CHECK(contains(help, "  " + std::string(info.name) + " "));
  }
}

TEST_CASE("a name that is no text is not written out, however deep its lists are") {
  constexpr std::size_t deep = 500'000;  // a line of the longest length that the socket takes
  CHECK(contains(refusal_of(R"({"command": )" + std::string(deep, '[') + std::string(deep, ']') + "}"),
                 "must be the name of a command"));
}
