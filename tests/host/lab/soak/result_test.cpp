#include "host/lab/soak/result.hpp"
#include "host/lab/soak/run.hpp"

#include <string>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

using namespace inkwell::soak;

namespace {

Soak some_soak() {
  Soak soak{.seed = 42, .sitting_s = 300, .use_s = 4, .stopped = false, .sittings = {}};
  Sitting first{.number = 1, .board_time_s = 301.5};
  first.phases = {{1, Kind::walls, 0.2, 2.0, "pressed"}, {2, Kind::fault, 2.2, 3.0, "supply_cut"}};
  first.faults_put_in = {{inkwell::protocol::InjectedFault::supply_cut, 1}};
  first.faults_told = {{inkwell::protocol::Fault::supply_low, 1}};
  first.peak_motor_force_N = 3.4;
  first.hardest_press = {.force_N = 3.0, .limit_N = 3.3, .phase = 1, .kind = Kind::walls, .board_time_s = 1.5};
  first.lost.poses = 2;
  first.lost.poses_kept_back = 71;
  Sitting second{.number = 2, .board_time_s = 300.0};
  second.phases = {{1, Kind::walls, 0.2, 4.0, ""}};
  second.peak_motor_force_N = 3.1;
  second.hardest_press = {.force_N = 1.02, .limit_N = 1.0, .phase = 1, .kind = Kind::walls, .board_time_s = 2.25};
  second.findings = {{1, Kind::walls, 3.25, Complaint::false_trip, "over_current"},
                     {1, Kind::walls, 3.5, Complaint::no_answer, "gone"}};
  soak.sittings = {first, second};
  return soak;
}

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

}  // namespace

TEST_CASE("the table sums the results of the boards and shows for each finding how to reproduce it") {
  const std::string table = table_of(some_soak());
  INFO(table);
  CHECK(has(table, "601.5 s"));
  CHECK(has(table, "2 (6 s)"));
  CHECK(has(table, "supply_low"));
  CHECK(has(table, "3.40 N"));
  CHECK(has(table, "1.020\n    1.02 of 1.00 N in 2.1 (walls) at 2.250 s\n"));
  CHECK(has(table, "the same with an injected fault                    -\n"));
  CHECK(has(table, "missing due to injected faults                    71\n"));
  CHECK(has(table, "false_trip in phase 1 (walls) at 3.250 s: over_current"));
  CHECK(has(table, "inkwell-lab soak --seed 42 --sitting 2 --sitting-seconds 300 --use-seconds 4"));
  CHECK(false_trip_count(some_soak()) == 1);
  CHECK(finding_count(some_soak()) == 2);
}

TEST_CASE("the JSON has each phase and finding, and the sums that a script asks for") {
  const auto json = nlohmann::json::parse(json_of(some_soak()));
  CHECK(json.at("seed") == 42);
  CHECK(json.at("findings") == 2);
  CHECK(json.at("false_trips") == 1);
  CHECK(json.at("sittings").at(0).at("phases").at(1).at("kind") == "fault");
  CHECK(json.at("sittings").at(0).at("lost").at("poses") == 2);
  CHECK(json.at("sittings").at(1).at("hardest_press").at("limit_N") == 1.0);
  CHECK(json.at("sittings").at(0).at("lost").at("poses_kept_back") == 71);
  CHECK(json.at("sittings").at(1).at("findings").at(0).at("text") == "over_current");
}

TEST_CASE("the result of a stopped soak shows that it was stopped early") {
  Soak soak = some_soak();
  CHECK_FALSE(has(table_of(soak), "stopped"));
  CHECK(nlohmann::json::parse(json_of(soak)).at("stopped") == false);
  soak.stopped = true;
  CHECK(has(table_of(soak), "stopped early"));
  CHECK(nlohmann::json::parse(json_of(soak)).at("stopped") == true);
}

TEST_CASE("so many sittings as share the time, one at least") {
  CHECK(sittings_in(3600, {.sitting_s = 300}) == 12);
  CHECK(sittings_in(3601, {.sitting_s = 300}) == 13);
  CHECK(sittings_in(1, {.sitting_s = 300}) == 1);
}
