// Runs a short soak test with each kind of phase and the flashed firmware. tools/lab/soak runs one hour. The soak test
// must have the requested duration.
#include <doctest/doctest.h>

#include <cmath>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <string>

#include <nlohmann/json.hpp>

#include "host/lab/soak/plan.hpp"
#include "tests/temporary_directory.hpp"

#include "tests/system/program.hpp"

using namespace inkwell;
using namespace inkwell::tests;

namespace {

nlohmann::json json_in(const std::string& file) {
  std::ifstream written(file);
  return nlohmann::json::parse(std::string{std::istreambuf_iterator<char>(written), {}});
}

}  // namespace

TEST_CASE("a short soak with every kind of phase finds nothing") {
  const TemporaryDirectory directory;
  const std::string file = directory.file("soak.json");
  const auto run = run_program("inkwell-lab", {"soak", "--seed", "1", "--sitting", "1", "--sitting-seconds", "36",
                                               "--use-seconds", "0.4", "--out", file});
  INFO(run.out, run.err);
  CHECK(run.exit_code == 0);
  const auto json = json_in(file);
  CHECK(json.at("false_trips") == 0);
  CHECK(json.at("findings") == 0);
  const auto& sitting = json.at("sittings").at(0);
  std::set<std::string> kinds;
  for (const auto& phase : sitting.at("phases")) kinds.insert(phase.at("kind"));
  CHECK(kinds.size() == soak::kind_table.size());
  const auto part_of_limit = [&](const char* which) {
    const auto& press = sitting.at(which);
    return press.at("force_N").get<double>() / press.at("limit_N").get<double>();
  };
  CHECK(part_of_limit("hardest_press") > 0.5);
  // The force at the time of a fault varies, so the bounds are low.
  CHECK(part_of_limit("hardest_press_with_fault") > 0.01);
  CHECK(part_of_limit("hardest_press_with_fault_over_ms") > 0.01);
  CHECK(sitting.at("transactions").get<int>() > 10);
  CHECK(sitting.at("faults_told").at("host_silent").get<int>() >= 1);
  CHECK(sitting.at("faults_told").at("usb_gone").get<int>() >= 1);
  CHECK(sitting.at("faults_told").at("over_speed").get<int>() >= 1);
  CHECK(sitting.at("restarts").get<int>() >= 1);
  CHECK(sitting.at("lost").at("poses") == 0);
}

TEST_CASE("the boards of a soak share the seconds that were asked for, and do the same each time") {
  const TemporaryDirectory directory;
  const auto soak = [&](const std::string& name, const std::string& jobs) {
    const auto run = run_program("inkwell-lab", {"soak", "--seconds", "3", "--sitting-seconds", "2", "--seed", "7",
                                                 "--jobs", jobs, "--out", directory.file(name)});
    INFO(run.out, run.err);
    CHECK(run.exit_code == 0);
    return json_in(directory.file(name));
  };
  const auto json = soak("one.json", "1");
  REQUIRE(json.at("sittings").size() == 2);
  for (const auto& sitting : json.at("sittings"))
    CHECK(std::fabs(sitting.at("board_time_s").get<double>() - 1.5) < 0.05);
  CHECK(json.at("stopped") == false);
  CHECK(soak("again.json", "2") == json);
  const auto alone = [&](const std::string& number) {
    // If an option is repeated, its last value is used, as tools/lab/soak requires.
    return run_program("inkwell-lab", {"soak", "--seconds", "3600", "--seconds", "3", "--sitting-seconds", "2",
                                       "--seed", "7", "--sitting", number, "--out", directory.file("alone.json")});
  };
  CHECK(alone("2").exit_code == 0);
  CHECK(json_in(directory.file("alone.json")).at("sittings").at(0) == json.at("sittings").at(1));
  const auto beyond = alone("3");
  CHECK(beyond.exit_code == 2);
  CHECK(beyond.err.find("A soak of --seconds 3 has only 2 sittings.") != std::string::npos);
}

TEST_CASE("a soak takes no time and no length that is no number") {
  const TemporaryDirectory directory;
  const std::string file = directory.file("soak.json");
  for (const char* option : {"--seconds", "--sitting-seconds", "--use-seconds"})
    for (const char* value : {"nan", "inf", "-1", "0"}) {
      const auto run = run_program("inkwell-lab", {"soak", "--sitting-seconds", "1", "--out", file, option, value});
      CAPTURE(run.err);
      CHECK(run.exit_code == 2);
      CHECK(run.err.find("from 0.1 to 1000000") != std::string::npos);
      CHECK_FALSE(std::filesystem::exists(file));
    }
}

TEST_CASE("a soak that cannot start its next board reports the reason and writes the results so far") {
  const TemporaryDirectory directory;
  const std::string file = directory.file("soak.json"), image = directory.file("inkwell.elf");
  std::filesystem::copy_file(build_directory() + "/../board/inkwell.elf", image);
  RunningProgram run({build_directory() + "/inkwell-lab", "--elf", image, "soak", "--seconds", "1000",
                      "--sitting-seconds", "2", "--use-seconds", "0.4", "--out", file});
  run.read_line();  // the first board is in use
  std::filesystem::remove(image);
  CHECK(run.wait() == 1);
  const auto json = json_in(file);
  CHECK(json.at("stopped") == true);
  CHECK(json.at("sittings").size() >= 1);
  CHECK(json.at("sittings").size() < 500);
}

TEST_CASE("a stopped soak writes the results so far") {
  const TemporaryDirectory directory;
  const std::string file = directory.file("soak.json");
  RunningProgram run(
      {build_directory() + "/inkwell-lab", "soak", "--seconds", "100000", "--use-seconds", "0.4", "--out", file});
  run.read_line();  // its first phase has finished
  CHECK_FALSE(std::filesystem::exists(file));
  kill(run.process(), SIGINT);
  CHECK(run.wait() == 0);
  const auto json = json_in(file);
  CHECK(json.at("stopped") == true);
  CHECK(json.at("sittings").at(0).at("phases").size() >= 1);
}
