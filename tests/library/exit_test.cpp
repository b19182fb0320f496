#include <doctest/doctest.h>

#include <array>
#include <string>

#include "tests/system/program.hpp"

namespace inkwell::tests {
namespace {

TEST_CASE("an object that lives as long as the program can read and close an arm") {
  // Freed memory is overwritten, so that a later read returns wrong values.
  RunningProgram program({build_directory() + "/library-closes-late"}, {"MALLOC_PERTURB_=85"});
  std::array<std::string, 4> in_main;
  for (auto& line : in_main) line = program.read_line();
  CHECK(in_main[0] == "pose 0");
  CHECK(in_main[3] == "error The arm is NULL. Pass a valid pointer.");
  for (const auto& line : in_main) CHECK(program.read_line() == line);
  CHECK(program.read_line() == "closed 0");
  CHECK(program.wait() == 0);
}

}  // namespace
}  // namespace inkwell::tests
