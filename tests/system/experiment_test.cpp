// Evaluates the recording of the experiment in section 4.3 of the paper.
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "host/client/recording/recording.hpp"

#include "tests/system/image.hpp"
#include "tests/system/program.hpp"

using namespace inkwell::tests;

namespace {

/// Columns of a recording by name, converted to double.
class Columns {
 public:
  explicit Columns(const std::string& file) {
    const auto recording = inkwell::recording::read(file);
    REQUIRE(recording.complete);
    REQUIRE(recording.remarks.empty());
    periods = recording.periods;
    for (const auto quantity : recording.quantities()) {
      names.emplace_back(inkwell::recording::name_of(quantity));
      const auto& column = recording.column(quantity);
      columns_[names.back()] = {column.begin(), column.end()};
    }
  }
  const std::vector<double>& operator[](const std::string& name) const { return columns_.at(name); }
  std::size_t size() const { return periods.size(); }

  std::vector<std::string> names;
  std::vector<std::int64_t> periods;

 private:
  std::map<std::string, std::vector<double>> columns_;
};

std::vector<std::string> expected_columns() {
  std::vector<std::string> names;
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

constexpr double sample_period_s = 50e-6;

constexpr Colour blue{0x00, 0x72, 0xb2}, vermilion{0xd5, 0x5e, 0x00}, green{0x00, 0x9e, 0x73};

struct Spread {
  double smallest, largest;
  double width() const { return largest - smallest; }
};

Spread spread(const std::vector<double>& values, std::size_t begin, std::size_t end) {
  const auto [smallest, largest] = std::minmax_element(values.begin() + static_cast<std::ptrdiff_t>(begin),
                                                       values.begin() + static_cast<std::ptrdiff_t>(end));
  return {*smallest, *largest};
}

/// Returns the start of the half second with the steadiest hand force deep in a wall.
std::size_t steadiest_hold(const Columns& recording, const std::string& axis, std::size_t length) {
  const auto& depth_m = recording["penetration_" + axis + "_m"];
  const auto& hand_N = recording["hand_force_" + axis + "_N"];
  const auto all = spread(depth_m, 0, depth_m.size());
  const double deep_m = 0.5 * std::max(std::abs(all.smallest), std::abs(all.largest));
  std::optional<std::size_t> best;
  double best_N = 0;
  for (std::size_t begin = 0; begin + length <= recording.size(); begin += length / 10) {
    const auto depth = spread(depth_m, begin, begin + length);
    if (std::min(std::abs(depth.smallest), std::abs(depth.largest)) < deep_m || depth.smallest * depth.largest < 0)
      continue;
    const double width_N = spread(hand_N, begin, begin + length).width();
    if (best && width_N >= best_N) continue;
    best = begin;
    best_N = width_N;
  }
  REQUIRE_MESSAGE(best.has_value(), "the sphere was never held in the wall for half a second");
  return *best;
}

}  // namespace

TEST_CASE("the experiment of the paper's section 4.3 runs end to end") {
  // All checks of this test use the same run.
  static const TemporaryDirectory directory;
  static const auto result = run_program("inkwell", {"experiment", "wall", "--virtual", "--out", directory.path()});
  INFO("output: ", result.out, result.err);
  REQUIRE(result.exit_code == 0);
  static const Columns recording(directory.file("recording.csv"));
  const auto summary = nlohmann::json::parse(std::ifstream(directory.file("summary.json")));
  CHECK(recording.names == expected_columns());
  CHECK(summary.at("simulation") == true);
  REQUIRE(recording.size() > 40'000);

  SUBCASE("it holds every control period") {
    std::size_t missing = 0;
    for (std::size_t i = 1; i < recording.size(); ++i) missing += recording.periods[i] != recording.periods[i - 1] + 1;
    CHECK(missing == 0);
    CHECK(summary.at("samples") == recording.size());
    CHECK(summary.at("samples_lost") == 0);
    CHECK(summary.at("pose_reports_lost") == 0);
  }

  SUBCASE("it is a table that any program reads: comments, a line of names, and a row for each period") {
    std::ifstream file(directory.file("recording.csv"));
    std::string line;
    std::vector<std::string> simulated;
    while (std::getline(file, line) && line.starts_with("# "))
      if (line.starts_with("# simulated ")) simulated.push_back(line.substr(12, line.find(" = ") - 12));
    // The file distinguishes simulated signals from device signals.
    CHECK(std::ranges::equal(simulated, std::span(recording.names).last(9)));
    CHECK(line.starts_with("time_s,encoder_1_counts,"));
    CHECK(std::ranges::count(line, ',') == 40);
    double worst_s = 0, before_s = 0;
    for (std::size_t i = 0; i < recording.size(); ++i) {
      REQUIRE(std::getline(file, line));
      REQUIRE(std::ranges::count(line, ',') == 40);
      const double time_s = std::stod(line);
      if (i > 0) worst_s = std::max(worst_s, std::abs(time_s - before_s - sample_period_s));
      before_s = time_s;
    }
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
        // While the proxy rests on the wall, the penetration rate d' is minus the probe velocity. The wall never pulls.
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

  SUBCASE("the measured values match the true values of the simulation") {
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
    CHECK(position_m < 250e-6);  // a few encoder counts, including the tolerance of the inkwell
    CHECK(position_m > 0);
    CHECK(current_A < 0.1);
    CHECK(current_A > 0);
  }

  SUBCASE("with a steady hand the position in the wall stays within two counts") {
    const std::string axis = summary.at("wall").get<std::string>().substr(0, 1);
    constexpr std::size_t length = 10'000;  // half a second
    const std::size_t begin = steadiest_hold(recording, axis, length);
    for (const std::string joint : {"1", "2", "3"}) {
      const auto counts = spread(recording["encoder_" + joint + "_counts"], begin, begin + length);
      MESSAGE("simulation: encoder ", joint, " spreads over ", counts.width(), " counts from ",
              static_cast<double>(begin) * sample_period_s, " s on");
      CHECK(counts.width() <= 2);
    }
    CHECK(spread(recording["force_N"], begin, begin + length).smallest > 1.0);
    // The summary must match the recording.
    const auto& hold = summary.at("steady_hold");
    CHECK(hold.at("duration_s") >= 0.5);
    const auto from = static_cast<std::size_t>(std::lround(hold.at("from_s").get<double>() / sample_period_s));
    const auto to = from + static_cast<std::size_t>(std::lround(hold.at("duration_s").get<double>() / sample_period_s));
    double widest = 0;
    for (const std::string joint : {"1", "2", "3"})
      widest = std::max(widest, spread(recording["encoder_" + joint + "_counts"], from, to).width());
    CHECK(hold.at("encoder_spread_counts").get<double>() == widest);
  }

  SUBCASE("the current follows its reference") {
    const Columns steps(directory.file("current-step.csv"));
    for (const std::string motor : {"1", "2", "3"}) {
      CAPTURE(motor);
      const auto& reference_A = steps["current_reference_" + motor + "_A"];
      const auto& current_A = steps["current_" + motor + "_A"];
      const auto on = [](double value) { return value != 0; };
      const auto rise = std::find_if(reference_A.begin(), reference_A.end(), on);
      REQUIRE(rise != reference_A.end());
      const double amplitude_A = *rise;
      CHECK(amplitude_A > 0.2);
      const auto begin = static_cast<std::size_t>(rise - reference_A.begin());
      const auto end = static_cast<std::size_t>(std::find(rise, reference_A.end(), 0.0) - reference_A.begin());
      REQUIRE(end - begin >= 200);  // 10 ms
      std::size_t risen = begin;
      while (risen < end && current_A[risen] < 0.632 * amplitude_A) ++risen;
      double peak_A = 0, sum_A = 0;
      const std::size_t settled = begin + (end - begin) / 2;
      for (std::size_t i = begin; i < end; ++i) {
        peak_A = std::max(peak_A, current_A[i]);
        if (i >= settled) sum_A += current_A[i];
      }
      const double mean_A = sum_A / static_cast<double>(end - settled);
      MESSAGE("simulation: motor ", motor, " has 63 % after ",
              1e6 * static_cast<double>(risen - begin) * sample_period_s, " us at most, overshoot ",
              100 * (peak_A / amplitude_A - 1), " %, steady error ", 1e3 * (mean_A - amplitude_A), " mA");
      CHECK(current_A[begin] < 0.1 * amplitude_A);
      CHECK(risen - begin <= 6);  // control periods: 300 us
      CHECK(peak_A < 1.1 * amplitude_A);
      CHECK(std::abs(mean_A - amplitude_A) < 0.01);
    }
  }

  SUBCASE("its figures can be drawn again from the recording alone, elsewhere and of a part") {
    std::filesystem::create_directory(directory.file("alone"));
    const std::string alone = directory.file("alone/recording.csv"), folder = directory.file("again");
    std::filesystem::copy_file(directory.file("recording.csv"), alone,
                               std::filesystem::copy_options::overwrite_existing);
    const auto plot = run_program("inkwell", {"plot", alone, "--paper", "--out", folder, "--from", "1", "--json"});
    INFO("standard error: ", plot.err);
    REQUIRE(plot.exit_code == 0);
    const auto pictures = nlohmann::json::parse(plot.out).at("pictures").get<std::vector<std::string>>();
    REQUIRE(pictures.size() == 4);
    for (const auto& picture : pictures) CHECK(read_png(picture).count(blue, 20) > 400);
  }

  SUBCASE("it is plotted and replayed as every recording is") {
    const std::string picture = directory.file("currents.png");
    const auto plot = run_program("inkwell", {"plot", directory.file("recording.csv"), "--signals",
                                              "current_1_A,true_current_1_A", "--out", picture});
    INFO("standard error: ", plot.err);
    REQUIRE(plot.exit_code == 0);
    const auto image = read_png(picture);
    CHECK(image.count(blue, 20) > 400);
    CHECK(image.count(vermilion, 20) > 400);
    const auto replay = run_program("inkwell", {"replay", directory.file("recording.csv"), "--json"});
    REQUIRE(replay.exit_code == 0);
    const auto about = nlohmann::json::parse(replay.out);
    CHECK(about.at("simulation") == true);
    CHECK(about.at("samples") == recording.size());
    CHECK(about.at("signals").size() == 31);
    REQUIRE(about.at("simulated").size() == 9);
    CHECK(about.at("simulated")[0].at("name") == "true_position_x_m");
    CHECK(about.at("simulated")[0].at("unit") == "m");
    CHECK(about.at("parameters").at("wall_stiffness_N_per_m") == summary.at("parameters").at("wall_stiffness_N_per_m"));
  }

  SUBCASE("the four figures show every line") {
    for (int number = 11; number <= 14; ++number) {
      CAPTURE(number);
      const auto image = read_png(directory.file("figure-" + std::to_string(number) + ".png"));
      CHECK(image.width >= 800);
      CHECK(image.count(blue, 20) > 400);
      CHECK((image.count(vermilion, 20) > 400) == (number >= 13));
      CHECK((image.count(green, 20) > 400) == (number >= 13));
      CHECK(image.count({255, 255, 255}, 0) < image.width * image.height * 99 / 100);
    }
  }
}

TEST_CASE("the experiment uses the given stiffness and damping, and does not overwrite its results") {
  const TemporaryDirectory directory;
  const std::vector<std::string> words{"experiment", "wall",      "--virtual", "--mode", "fast",          "--stiffness",
                                       "1200",       "--damping", "3",         "--out",  directory.path()};
  const auto result = run_program("inkwell", words);
  INFO("output: ", result.out, result.err);
  REQUIRE(result.exit_code == 0);
  const auto summary = nlohmann::json::parse(std::ifstream(directory.file("summary.json")));
  CHECK(summary.at("parameters").at("wall_stiffness_N_per_m") == 1200);
  CHECK(summary.at("parameters").at("wall_damping_Ns_per_m") == 3);
  const auto again = run_program("inkwell", words);
  CHECK(again.exit_code != 0);
  CHECK(again.err.find("recording.csv exists") != std::string::npos);
}

TEST_CASE("the experiment refuses a wall that the arm cannot reach before it starts") {
  const TemporaryDirectory directory;
  const auto result = run_program(
      "inkwell", {"experiment", "wall", "--virtual", "--mode", "fast", "--wall", "z-", "--out", directory.path()});
  INFO("output: ", result.out, result.err);
  CHECK(result.exit_code != 0);
  CHECK(result.err.find("cannot reach the wall z-") != std::string::npos);
  CHECK(result.err.find("The hand pushes") == std::string::npos);
}

TEST_CASE("the experiment runs with the paper's arm too") {
  const TemporaryDirectory directory;
  const auto result =
      run_program("inkwell", {"experiment", "wall", "--virtual", "--mode", "fast", "--arm",
                              build_directory() + "/../../boards/arms/paper.toml", "--out", directory.path()});
  INFO("output: ", result.out, result.err);
  REQUIRE(result.exit_code == 0);
  const auto summary = nlohmann::json::parse(std::ifstream(directory.file("summary.json")));
  CHECK(summary.at("parameters").at("transmission") == 0);
  CHECK(summary.at("force_maximum_N") > 1.0);
}
