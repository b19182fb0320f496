#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include <experiment/figures.hpp>
#include <experiment/recording.hpp>
#include <temporary_directory.hpp>

using namespace inkwell;
using namespace inkwell::experiment;
using inkwell::tests::TemporaryDirectory;

namespace {

std::string read_file(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

ScopeRecording scope_of(std::size_t samples, std::uint32_t first_period) {
  ScopeRecording scope;
  scope.signals = recorded_signals();
  scope.first_period = first_period;
  for (std::size_t i = 0; i < samples; ++i)
    for (std::size_t j = 0; j < scope.signals.size(); ++j)
      scope.values.push_back(static_cast<float>(i) + 0.01f * static_cast<float>(j));
  return scope;
}

device::Trace trace_of(std::uint64_t first_period, std::size_t rows) {
  device::Trace trace;
  trace.columns = {"period",
                   "board_time_s",
                   "true_position_x_m",
                   "true_position_y_m",
                   "true_position_z_m",
                   "true_velocity_x_m_s",
                   "true_current_1_A",
                   "true_current_2_A",
                   "true_current_3_A",
                   "hand_force_x_N",
                   "hand_force_y_N",
                   "hand_force_z_N"};
  for (std::size_t i = 0; i < rows; ++i)
    for (std::size_t j = 0; j < trace.columns.size(); ++j)
      trace.values.push_back(j == 0 ? static_cast<double>(first_period + i)
                                    : static_cast<double>(first_period + i) + 0.001 * static_cast<double>(j));
  return trace;
}

}  // namespace

TEST_CASE("the columns of a recording are those that users read, in that order") {
  const auto trace = trace_of(10, 3);
  const TemporaryDirectory directory;
  write_csv(make_recording(scope_of(2, 11), &trace), directory / "recording.csv");
  const std::string text = read_file(directory / "recording.csv");
  CHECK(text.substr(0, text.find('\n')) ==
        "time_s,encoder_1_counts,encoder_2_counts,encoder_3_counts,joint_1_rad,joint_2_rad,joint_3_rad,"
        "position_x_m,position_y_m,position_z_m,velocity_x_m_s,velocity_y_m_s,velocity_z_m_s,"
        "penetration_x_m,penetration_y_m,penetration_z_m,force_x_N,force_y_N,force_z_N,force_N,"
        "torque_1_Nm,torque_2_Nm,torque_3_Nm,current_reference_1_A,current_reference_2_A,current_reference_3_A,"
        "current_1_A,current_2_A,current_3_A,duty_1,duty_2,duty_3,"
        "true_position_x_m,true_position_y_m,true_position_z_m,true_current_1_A,true_current_2_A,true_current_3_A,"
        "hand_force_x_N,hand_force_y_N,hand_force_z_N");
  CHECK(std::count(text.begin(), text.end(), '\n') == 3);
}

TEST_CASE("truth is matched by control period, and a gap in it is an error") {
  const auto trace = trace_of(10, 5);
  const auto recording = make_recording(scope_of(3, 12), &trace);
  CHECK(recording.size() == 3);
  CHECK(recording.values_of("time_s")[2] == doctest::Approx(100e-6));
  CHECK(recording.values_of("true_position_x_m")[0] == doctest::Approx(12.002));
  CHECK(recording.values_of("hand_force_z_N")[2] == doctest::Approx(14.011));
  CHECK_THROWS_AS(make_recording(scope_of(4, 12), &trace), device::Error);
  CHECK_THROWS_AS(make_recording(scope_of(1, 9), &trace), device::Error);
}

TEST_CASE("without a simulation there are no columns of truth") {
  const auto recording = make_recording(scope_of(1, 0), nullptr);
  CHECK(recording.columns().size() == 32);
  CHECK_FALSE(recording.has_column("true_position_x_m"));
  CHECK_THROWS_AS(recording.column("true_position_x_m"), device::Error);
}

TEST_CASE("scope samples are laid end to end and losses add up") {
  ScopeRecording scope;
  scope.append({{protocol::Signal::force_N}, 100, 2, {1, 2}, 0});
  scope.append({{protocol::Signal::force_N}, 105, 1, {3}, 3});
  CHECK(scope.size() == 3);
  CHECK(scope.first_period == 100);
  CHECK(scope.lost_samples == 3);
}

TEST_CASE("a recording that cannot be written whole is an error") {
  CHECK_THROWS_AS(write_csv(make_recording(scope_of(1, 0), nullptr), "/nowhere/recording.csv"), device::Error);
  CHECK_THROWS_AS(write_csv(make_recording(scope_of(5000, 0), nullptr), "/dev/full"), device::Error);
}

TEST_CASE("figures show mean and extremes of each millisecond") {
  const auto recording = make_recording(scope_of(60, 0), nullptr);
  FigureOptions options;
  options.parameters = protocol::default_parameters();
  options.wall = {2, 1};
  const auto data = figure_data(recording, options);
  CHECK(data.size() == 3);
  const double force_offset = 0.18;  // column 18 of the signals
  CHECK(data.values_of("force_N_mean")[1] == doctest::Approx(29.5 + force_offset));
  CHECK(data.values_of("force_N_minimum")[1] == doctest::Approx(20 + force_offset));
  CHECK(data.values_of("force_N_maximum")[1] == doctest::Approx(39 + force_offset));
}

TEST_CASE("gnuplot draws the four figures") {
  const TemporaryDirectory directory;
  FigureOptions options;
  options.simulation = true;
  options.arm = "an arm's name with 'quotes'";
  options.parameters = protocol::default_parameters();
  options.shown = {0, 0.05};
  draw_figures(make_recording(scope_of(1000, 0), nullptr), options, directory.path());
  for (int number = 11; number <= 14; ++number) {
    const auto file = directory / ("figure-" + std::to_string(number) + ".png");
    REQUIRE(std::filesystem::exists(file));
    CHECK(std::filesystem::file_size(file) > 10'000);
    CHECK(read_file(file).substr(1, 3) == "PNG");
  }
}
