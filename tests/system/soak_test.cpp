// A short soak: each kind of phase at least once, with the firmware that is flashed. tools/soak runs an hour of it.
#include <doctest/doctest.h>

#include <fstream>
#include <iterator>
#include <set>
#include <string>

#include <nlohmann/json.hpp>

#include <soak/plan.hpp>
#include <temporary_directory.hpp>

#include "program.hpp"

using namespace inkwell;
using namespace inkwell::tests;

TEST_CASE("a short soak with every kind of phase finds nothing") {
  const TemporaryDirectory directory;
  const std::string file = directory.file("soak.json");
  const auto run = run_program("inkwell", {"soak", "--seed", "1", "--sitting", "1", "--sitting-seconds", "1",
                                           "--use-seconds", "0.4", "--out", file});
  INFO(run.out, run.err);
  CHECK(run.exit_code == 0);
  std::ifstream written(file);
  const auto json = nlohmann::json::parse(std::string{std::istreambuf_iterator<char>(written), {}});
  CHECK(json.at("false_trips") == 0);
  CHECK(json.at("findings") == 0);
  const auto& sitting = json.at("sittings").at(0);
  std::set<std::string> kinds;
  for (const auto& phase : sitting.at("phases")) kinds.insert(phase.at("kind"));
  CHECK(kinds.size() == soak::kind_table.size());
  CHECK(sitting.at("peak_part_of_limit").get<double>() > 0.5);
  CHECK(sitting.at("transactions").get<int>() > 10);
  CHECK(sitting.at("faults_told").at("host_silent").get<int>() >= 1);
  CHECK(sitting.at("faults_told").at("over_speed").get<int>() >= 1);
  CHECK(sitting.at("restarts").get<int>() >= 1);
}
