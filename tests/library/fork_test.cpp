#include <doctest/doctest.h>

#include <sys/wait.h>
#include <unistd.h>

#include <fstream>
#include <string>

#include <inkwell/inkwell.h>
#include "tests/dropins/board.hpp"
#include "tests/system/program.hpp"
#include "tests/temporary_directory.hpp"

#include "tests/library/virtual_arm.hpp"

namespace inkwell::tests {
namespace {

TEST_CASE("forked children neither use nor disturb their parent's arm, and may open another arm") {
  const TemporaryDirectory directory;
  std::string file;
  SUBCASE("while CSV is written") { file = directory.file("parent.csv"); }
  SUBCASE("while HDF5 is written") { file = directory.file("parent.h5"); }
  const auto run = run_program("library-forks", {file});
  CHECK_MESSAGE(run.exit_code == 0, run.out, run.err);
  CHECK_MESSAGE(run.out.starts_with("servo runs\nsamples "), run.out, run.err);
  const unsigned long samples = std::stoul(run.out.substr(run.out.find("samples ") + 8));
  if (!file.ends_with(".csv")) return;
  // No line is written twice.
  std::ifstream text(file);
  unsigned long rows = 0;
  double time_s = -1;
  for (std::string line; std::getline(text, line);) {
    if (line.empty() || line[0] == '#' || line[0] == 't') continue;
    const double next_s = std::stod(line);
    CHECK(next_s > time_s);
    time_s = next_s;
    ++rows;
  }
  CHECK(rows == samples);
}

/// Runs in a child. Returns 0 if the child can drive an arm and can close its parent's handle without a message.
int try_to_drive(inkwell_arm* of_parent, const std::string& address) {
  const double none_N[3]{};
  inkwell_arm* own = nullptr;
  if (inkwell_open(address.c_str(), &own) != INKWELL_OK) return 1;
  if (inkwell_set_force(own, none_N) != INKWELL_IN_USE) return 2;
  if (!says("(process " + std::to_string(getppid()) + ")")) return 3;
  if (inkwell_close(own) != INKWELL_OK || inkwell_close(of_parent) != INKWELL_OK) return 4;
  return 0;
}

TEST_CASE("a forked child has no part in the claim of its parent") {
  Board board;
  const VirtualArm driver(board.address);
  const double none_N[3]{};
  REQUIRE(inkwell_set_force(driver.arm, none_N) == INKWELL_OK);
  const pid_t child = fork();
  if (child == 0) {
    alarm(120);
    _exit(try_to_drive(driver.arm, board.address));
  }
  int status = 0;
  waitpid(child, &status, 0);
  CHECK(WIFEXITED(status));
  CHECK(WEXITSTATUS(status) == 0);
  inkwell_driver left{};
  REQUIRE(inkwell_get_driver(driver.arm, &left) == INKWELL_OK);
  CHECK(left.is_this_arm == 1);
}

}  // namespace
}  // namespace inkwell::tests
