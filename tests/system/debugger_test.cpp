// Tests GDB with the virtual board and the flashed firmware.
#include <doctest/doctest.h>

#include "tests/system/program.hpp"

using namespace inkwell::tests;

namespace {

/// Runs `commands` in GDB on the board at `port` and returns the output.
std::string gdb(const std::string& elf, const std::string& port, std::initializer_list<const char*> commands) {
  std::vector<std::string> arguments{"-nx", "-batch", elf, "-ex", "target remote 127.0.0.1:" + port};
  for (const char* command : commands) {
    arguments.emplace_back("-ex");
    arguments.emplace_back(command);
  }
  const auto result = run_program("/usr/bin/gdb-multiarch", arguments);
  return result.out + result.err;
}

std::string word_after(const std::string& text, const std::string& mark) {
  const auto at = text.find(mark);
  REQUIRE(at != std::string::npos);
  const auto begin = at + mark.size();
  return text.substr(begin, text.find_first_of(" \n", begin) - begin);
}

}  // namespace

TEST_CASE("GDB stops in the control interrupt, reads registers, steps, watches a variable and detaches") {
  const std::string elf = build_directory() + "/../board/inkwell.elf";
  RunningProgram board({build_directory() + "/virtual-board", "--elf", elf, "--gdb", "0"});
  const std::string port = word_after(board.read_line(), "gdb=");

  const std::string said =
      gdb(elf, port,
          {"monitor reset", "maintenance flush register-cache", "info symbol $pc", "break control_interrupt",
           "continue", "print $xpsr & 0x1ff", "monitor time", "shell sleep 0.3", "monitor time", "set $before = $pc",
           "stepi", "print $pc - $before", "delete", "watch *(unsigned*)&inkwell::application::completed_periods",
           "continue", "print *(unsigned*)0xe000ed08 == (unsigned)&interrupt_vectors", "detach"});
  CAPTURE(said);
  CHECK(said.find("reset_handler in section") != std::string::npos);
  CHECK(said.find("Breakpoint 1, inkwell::application::control_interrupt") != std::string::npos);
  CHECK(said.find("$1 = 34\n") != std::string::npos);  // interrupt 18, of the ADCs
  CHECK(said.find("Hardware watchpoint") != std::string::npos);
  CHECK(said.find("Old value = 0") != std::string::npos);
  CHECK(said.find("New value = 1") != std::string::npos);
  const auto moved = word_after(said, "$2 = ");
  CHECK((moved == "2" || moved == "4"));
  CHECK(said.find("$3 = true\n") != std::string::npos);  // VTOR: the exception handlers do not depend on the flash
  // Board time does not advance while GDB has stopped the board.
  constexpr const char* unit = " s of board time";
  const auto first = said.find(unit), second = said.find(unit, first + 1);
  REQUIRE(second != std::string::npos);
  CHECK(said.substr(first - 11, 11) == said.substr(second - 11, 11));

  // A second GDB session continues from the same point.
  const std::string again = gdb(elf, port, {"print *(unsigned*)&inkwell::application::completed_periods", "kill"});
  CAPTURE(again);
  CHECK(std::stoul(word_after(again, "$1 = ")) >= 1);
}

TEST_CASE("GDB needs exact mode") {
  const auto result = run_program("virtual-board", {"--elf", "x.elf", "--gdb", "0", "--mode", "fast"});
  CHECK(result.exit_code == 2);
  CHECK(result.err.find("--mode") != std::string::npos);
}
