// A program that forks while it has an arm open.
#include <doctest/doctest.h>

#include <fstream>
#include <string>

#include <temporary_directory.hpp>

#include <system/program.hpp>

namespace inkwell::tests {
namespace {

TEST_CASE("forked children neither use nor disturb their parent's arm, and may open one of their own") {
  const TemporaryDirectory directory;
  std::string file;
  SUBCASE("while CSV is written") { file = directory.file("parent.csv"); }
  SUBCASE("while HDF5 is written") { file = directory.file("parent.h5"); }
  const auto run = run_program("library-forks", {file});
  CHECK_MESSAGE(run.exit_code == 0, run.out, run.err);
  CHECK_MESSAGE(run.out.starts_with("servo runs\nsamples "), run.out, run.err);
  const unsigned long samples = std::stoul(run.out.substr(run.out.find("samples ") + 8));
  if (!file.ends_with(".csv")) return;
  // Not a line twice.
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

}  // namespace
}  // namespace inkwell::tests
