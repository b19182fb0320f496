#include "host/lab/experiment/summary_json.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "protocol/reports.hpp"

namespace inkwell::experiment {
namespace {

using nlohmann::ordered_json;

/// Returns 0.2 instead of 0.20000000298.
double shortest(float value) { return std::stod(fmt::format("{}", value)); }

ordered_json interval_json(const Interval& interval) { return {{"from_s", interval.from_s}, {"to_s", interval.to_s}}; }

/// Returns the values of each motor and the worst values.
ordered_json current_step_json(const std::vector<recording::CurrentStep>& steps) {
  recording::CurrentStep worst;
  ordered_json motors = ordered_json::array();
  for (const auto& step : steps) {
    worst.amplitude_A = std::max(worst.amplitude_A, step.amplitude_A);
    worst.rise_time_s = std::max(worst.rise_time_s, step.rise_time_s);
    worst.overshoot = std::max(worst.overshoot, step.overshoot);
    if (std::abs(step.steady_error_A) > std::abs(worst.steady_error_A)) worst.steady_error_A = step.steady_error_A;
    motors.push_back({{"amplitude_A", step.amplitude_A},
                      {"rise_time_s", step.rise_time_s},
                      {"overshoot", step.overshoot},
                      {"steady_error_A", step.steady_error_A}});
  }
  return {{"amplitude_A", worst.amplitude_A},
          {"rise_time_s", worst.rise_time_s},
          {"overshoot", worst.overshoot},
          {"steady_error_A", worst.steady_error_A},
          {"motors", motors}};
}

}  // namespace

ordered_json summary_json(const Circumstances& circumstances, const WallResult& result,
                          const std::vector<recording::CurrentStep>& steps) {
  ordered_json summary;
  const auto& about = circumstances.about;
  summary["simulation"] = about.simulation;
  summary["experiment"] = "wall";
  summary["wall"] = wall_name(circumstances.wall);
  summary["arm"] = about.arm;
  summary["versions"] = {
      {"companion", INKWELL_VERSION}, {"firmware", about.firmware_version}, {"protocol", about.protocol_version}};
  summary["serial_number"] = about.serial_number;
  if (circumstances.virtual_board) {
    summary["mode"] = circumstances.virtual_board->mode == device::SimulationMode::exact ? "exact" : "fast";
    summary["seed"] = circumstances.virtual_board->seed;
  }
  summary["sample_rate_Hz"] = protocol::servo_rate_Hz;
  summary["samples"] = result.samples;
  summary["samples_lost"] = result.samples_lost;
  summary["samples_in_contact"] = result.samples_in_contact;
  if (result.contact) summary["contact"] = interval_json(*result.contact);
  summary["pose_reports_received"] = circumstances.poses_received;
  summary["pose_reports_lost"] = circumstances.poses_lost;
  summary["penetration_maximum_m"] = result.penetration_maximum_m;
  summary["force_maximum_N"] = result.force_maximum_N;
  summary["torque_1_maximum_Nm"] = result.torque_1_maximum_Nm;
  summary["torque_2_and_3_maximum_Nm"] = result.other_torques_maximum_Nm;
  summary["force_law"] = {{"samples", result.force_law_error.samples},
                          {"error_maximum_N", result.force_law_error.maximum_N},
                          {"error_maximum_relative", result.force_law_error.maximum_relative},
                          {"samples_outside_1_percent_and_5_mN", result.force_law_error.samples_outside}};
  if (const auto& hold = result.steady_hold) {
    const auto& spread = hold->encoder_spread_counts;
    summary["steady_hold"] = {{"from_s", hold->interval.from_s},
                              {"duration_s", hold->interval.to_s - hold->interval.from_s},
                              {"encoder_spread_counts", *std::max_element(spread.begin(), spread.end())},
                              {"encoders_spread_counts", spread},
                              {"position_spread_m", hold->position_spread_m},
                              {"penetration_mean_m", hold->penetration_mean_m}};
  }
  if (!steps.empty()) summary["current_step"] = current_step_json(steps);
  ordered_json parameters;
  for (std::size_t i = 0; i < protocol::known_parameters().size(); ++i)
    parameters[std::string(protocol::known_parameters()[i].name)] = shortest(about.parameters.values[i]);
  summary["parameters"] = parameters;
  return summary;
}

}  // namespace inkwell::experiment
