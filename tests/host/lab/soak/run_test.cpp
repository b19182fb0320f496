// Tests the boards of a soak test; a shell script replaces the virtual board.
#include "host/lab/soak/run.hpp"

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include <doctest/doctest.h>

#include "host/client/device/error.hpp"
#include "tests/temporary_directory.hpp"

using namespace inkwell;
using inkwell::tests::TemporaryDirectory;

TEST_CASE("a sitting runs on a board with the brown-out level of one that was flashed") {
  const TemporaryDirectory directory;
  const auto program = directory / "board";
  std::ofstream(program) << "#!/bin/sh\necho \"$@\" > '" << directory.path() << "/arguments'\nexit 1\n";
  std::filesystem::permissions(program, std::filesystem::perms::owner_all);
  CHECK_THROWS_AS(soak::run_sitting(1, {}, {.program = program, .elf = program}), device::Error);
  std::ifstream file(directory / "arguments");
  const std::string arguments{std::istreambuf_iterator<char>(file), {}};
  CHECK(arguments.find(" --brown-out 3 ") != std::string::npos);
}
