// Output that is lost, for example on a full disk, is an error of every program and command.
#include <doctest/doctest.h>

#include <string>
#include <vector>

#include "host/client/device/virtual_board.hpp"

#include "tests/system/program.hpp"

using namespace inkwell;
using namespace inkwell::tests;

namespace {

/// Runs a program whose standard output is /dev/full.
ProgramResult run_without_output(const std::string& program, const std::vector<std::string>& arguments) {
  std::vector<std::string> words{"-c", "exec \"$0\" \"$@\" > /dev/full", build_directory() + "/" + program};
  words.insert(words.end(), arguments.begin(), arguments.end());
  return run_program("/bin/sh", words);
}

void check_output_is_missed(const std::string& program, const std::vector<std::string>& arguments) {
  const auto result = run_without_output(program, arguments);
  std::string command = program;
  for (const auto& argument : arguments) command += " " + argument;
  INFO(command, ": ", result.err);
  CHECK(result.exit_code == 1);
  const std::string sentence = program + ": Standard output cannot be written";
  const auto at = result.err.find(sentence);
  REQUIRE(at != std::string::npos);
  CHECK(result.err.find(sentence, at + 1) == std::string::npos);
}

/// Returns the commands that `program --help` lists.
std::vector<std::string> commands_of(const std::string& program) {
  const std::string help = run_program(program, {"--help"}).out;
  std::vector<std::string> commands;
  bool is_list = false;
  for (std::size_t at = 0; at < help.size();) {
    const auto end = std::min(help.find('\n', at), help.size());
    const std::string line = help.substr(at, end - at);
    at = end + 1;
    if (!line.starts_with(" "))
      is_list = line.find("ommands:") != std::string::npos || line.find("OMMANDS:") != std::string::npos;
    else if (is_list && line.starts_with("  ") && line[2] != ' ')
      commands.push_back(line.substr(2, line.find(' ', 2) - 2));
  }
  return commands;
}

}  // namespace

TEST_CASE("a lost help text or version is an error of every program and command") {
  for (const char* program : {"inkwell", "inkwell-lab"}) {
    check_output_is_missed(program, {"--help"});
    check_output_is_missed(program, {"--version"});
    const auto commands = commands_of(program);
    CHECK(commands.size() >= 2);
    for (const auto& command : commands) check_output_is_missed(program, {command, "--help"});
  }
  check_output_is_missed("virtual-board", {"--help"});
}

TEST_CASE("a lost result is an error of every command that prints one") {
  const device::VirtualBoard board{device::VirtualBoardOptions{}};
  const std::vector<std::vector<std::string>> commands{{"info"},
                                                       {"signals"},
                                                       {"fault"},
                                                       {"devices"},
                                                       {"force"},
                                                       {"parameters"},
                                                       {"parameters", "get", "box_minimum_x_m"},
                                                       {"parameters", "stored"},
                                                       {"self-test"}};
  for (const auto& command : commands)
    for (const bool json : {false, true}) {
      auto words = command;
      if (command != std::vector<std::string>{"devices"}) words.insert(words.end(), {"--usbip", board.usbip().text()});
      if (json) words.emplace_back("--json");
      check_output_is_missed("inkwell", words);
    }
  check_output_is_missed("inkwell", {"reference"});
  check_output_is_missed("inkwell-lab", {"campaign", "list"});
}

TEST_CASE("a watch without an end stops when its output is lost") {
  check_output_is_missed("inkwell", {"watch", "--virtual"});
  check_output_is_missed("inkwell", {"watch", "--virtual", "--json"});
}

TEST_CASE("a virtual board that cannot announce its addresses exits") {
  check_output_is_missed("virtual-board", {"--elf", build_directory() + "/../board/inkwell.elf"});
}

TEST_CASE("lost error messages do not abort a program") {
  const auto result =
      run_program("/bin/sh", {"-c", "exec \"$0\" no-such-command 2> /dev/full", build_directory() + "/inkwell"});
  CHECK(result.exit_code == 2);
}
