// The paper's section 4.3, end to end, judged by the recording and not by the experiment's own summary.
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "image.hpp"
#include "program.hpp"

using namespace inkwell::tests;

namespace {

class Recording {
 public:
  explicit Recording(const std::string& path) {
    std::ifstream file(path);
    std::string line, cell;
    REQUIRE(std::getline(file, line));
    for (std::istringstream cells(line); std::getline(cells, cell, ',');) names.push_back(cell);
    std::vector<std::vector<double>> columns(names.size());
    while (std::getline(file, line)) {
      const char* at = line.c_str();
      for (std::size_t i = 0; i < names.size(); ++i) {
        char* end = nullptr;
        columns[i].push_back(std::strtod(at, &end));
        REQUIRE(end != at);
        at = *end == ',' ? end + 1 : end;
      }
      REQUIRE(*at == '\0');
    }
    for (std::size_t i = 0; i < names.size(); ++i) columns_[names[i]] = std::move(columns[i]);
  }
  const std::vector<double>& operator[](const std::string& name) const { return columns_.at(name); }
  std::size_t size() const { return columns_.begin()->second.size(); }

  std::vector<std::string> names;

 private:
  std::map<std::string, std::vector<double>> columns_;
};

std::vector<std::string> expected_columns() {
  std::vector<std::string> names{"time_s"};
  const auto numbered = [&](const std::string& before, const std::string& after) {
    for (int i = 1; i <= 3; ++i) names.push_back(before + std::to_string(i) + after);
  };
  const auto axes = [&](const std::string& before, const std::string& after) {
    for (const char* axis : {"x", "y", "z"}) names.push_back(before + axis + after);
  };
  numbered("encoder_", "_counts");
  numbered("joint_", "_rad");
  axes("position_", "_m");
  axes("velocity_", "_m_s");
  axes("penetration_", "_m");
  axes("force_", "_N");
  names.push_back("force_N");
  numbered("torque_", "_Nm");
  numbered("current_reference_", "_A");
  numbered("current_", "_A");
  numbered("duty_", "");
  axes("true_position_", "_m");
  numbered("true_current_", "_A");
  axes("hand_force_", "_N");
  return names;
}

const std::array<std::string, 3> axis_names{"x", "y", "z"};

}  // namespace

TEST_CASE("the experiment of the paper's section 4.3 runs end to end") {
  // One run for all that is looked at below.
  static const TemporaryDirectory directory;
  static const auto result = run_program("inkwell", {"experiment", "wall", "--virtual", "--out", directory.path()},
                                         std::chrono::seconds(300));
  INFO("output: ", result.out, result.err);
  REQUIRE(result.exit_code == 0);
  static const Recording recording(directory.file("recording.csv"));
  const auto summary = nlohmann::json::parse(std::ifstream(directory.file("summary.json")));
  CHECK(recording.names == expected_columns());
  CHECK(summary.at("simulation") == true);
  REQUIRE(recording.size() > 40'000);

  SUBCASE("it holds every control period") {
    const auto& time_s = recording["time_s"];
    double worst_s = 0;
    for (std::size_t i = 1; i < time_s.size(); ++i)
      worst_s = std::max(worst_s, std::abs(time_s[i] - time_s[i - 1] - 50e-6));
    CHECK(worst_s < 1e-6);
  }

  SUBCASE("in contact, the force is k d + c d'") {
    const double k = summary.at("parameters").at("wall_stiffness_N_per_m");
    const double c = summary.at("parameters").at("wall_damping_Ns_per_m");
    std::size_t in_contact = 0, wrong = 0;
    double largest_N = 0;
    for (const auto& axis : axis_names) {
      const auto& penetration_m = recording["penetration_" + axis + "_m"];
      const auto& velocity_m_s = recording["velocity_" + axis + "_m_s"];
      const auto& force_N = recording["force_" + axis + "_N"];
      for (std::size_t i = 0; i < recording.size(); ++i) {
        if (penetration_m[i] == 0) {
          wrong += force_N[i] != 0;
          continue;
        }
        ++in_contact;
        // The proxy rests on the wall, so d' is minus the velocity; the wall never pulls.
        const double outward = penetration_m[i] > 0 ? 1 : -1;
        const double expected_N = outward * std::max(0.0, outward * (k * penetration_m[i] - c * velocity_m_s[i]));
        wrong += std::abs(force_N[i] - expected_N) > std::max(0.005, 0.01 * std::abs(expected_N));
        largest_N = std::max(largest_N, std::abs(force_N[i]));
      }
    }
    CHECK(in_contact > 10'000);
    CHECK(largest_N > 1.0);
    CHECK(wrong == 0);
  }

  SUBCASE("the wall's torque about the vertical axis is zero while the push lies in the arm's plane") {
    double waist_Nm = 0, others_Nm = 0;
    for (std::size_t i = 0; i < recording.size(); ++i) {
      waist_Nm = std::max(waist_Nm, std::abs(recording["torque_1_Nm"][i]));
      others_Nm = std::max({others_Nm, std::abs(recording["torque_2_Nm"][i]), std::abs(recording["torque_3_Nm"][i])});
    }
    MESSAGE("simulation: T1z at most ", waist_Nm, " Nm beside ", others_Nm, " Nm");
    CHECK(others_Nm > 0.1);
    CHECK(waist_Nm < 0.01 * others_Nm);
  }

  SUBCASE("what the firmware measures is what the simulation knows") {
    double position_m = 0, current_A = 0;
    for (std::size_t i = 0; i < recording.size(); ++i) {
      for (const auto& axis : axis_names)
        position_m = std::max(position_m, std::abs(recording["position_" + axis + "_m"][i] -
                                                   recording["true_position_" + axis + "_m"][i]));
      for (const char* motor : {"1", "2", "3"})
        current_A = std::max(current_A, std::abs(recording[std::string("current_") + motor + "_A"][i] -
                                                 recording[std::string("true_current_") + motor + "_A"][i]));
    }
    MESSAGE("simulation: position off by at most ", position_m * 1e6, " um, current by ", current_A * 1e3, " mA");
    CHECK(position_m < 250e-6);  // a few encoder counts, the inkwell's tolerance included
    CHECK(position_m > 0);
    CHECK(current_A < 0.1);
    CHECK(current_A > 0);
  }

  SUBCASE("with a steady hand the position in the wall stays within two counts") {
    CHECK(summary.at("steady_hold").at("encoder_spread_counts") <= 2);
    CHECK(summary.at("steady_hold").at("duration_s") >= 0.5);
  }

  SUBCASE("the current follows its reference") {
    const auto& step = summary.at("current_step");
    CHECK(step.at("rise_time_s") > 0);
    CHECK(step.at("rise_time_s") <= 0.0003);
    CHECK(step.at("overshoot") < 0.10);
    CHECK(std::abs(step.at("steady_error_A").get<double>()) < 0.01);
  }

  SUBCASE("the four figures show something") {
    for (int number = 11; number <= 14; ++number) {
      const auto image = read_png(directory.file("figure-" + std::to_string(number) + ".png"));
      CHECK(image.width >= 800);
      CHECK(image.colours() > 20);
      CHECK(image.count({255, 255, 255}, 0) < image.width * image.height * 99 / 100);
    }
  }
}

TEST_CASE("the experiment runs with the paper's arm too") {
  const TemporaryDirectory directory;
  const auto result =
      run_program("inkwell", {"experiment", "wall", "--virtual", "--arm", build_directory() + "/../../boards/arms/paper.toml",
                              "--out", directory.path()},
                  std::chrono::seconds(300));
  INFO("output: ", result.out, result.err);
  REQUIRE(result.exit_code == 0);
  const auto summary = nlohmann::json::parse(std::ifstream(directory.file("summary.json")));
  CHECK(summary.at("parameters").at("transmission") == 0);
  CHECK(summary.at("force_maximum_N") > 1.0);
}
