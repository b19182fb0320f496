#include <experiment/summary.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include <protocol/reports.hpp>

namespace inkwell::experiment {
namespace {

using protocol::Parameter;
using protocol::ParameterSet;

constexpr double relative_error_floor_N = 0.5;
constexpr double tolerance_N = 0.005, tolerance_relative = 0.01;
constexpr double hold_duration_s = 0.5;
constexpr double rise_level = 0.632;

constexpr Parameter wall_parameters[3][2] = {
    {Parameter::box_minimum_x_m, Parameter::box_maximum_x_m},
    {Parameter::box_minimum_y_m, Parameter::box_maximum_y_m},
    {Parameter::box_minimum_z_m, Parameter::box_maximum_z_m},
};

std::array<std::size_t, 3> vector_columns(const Recording& recording, const char* pattern) {
  std::array<std::size_t, 3> columns{};
  for (int axis = 0; axis < 3; ++axis)
    columns[static_cast<std::size_t>(axis)] = recording.column(fmt::format(fmt::runtime(pattern), axis_letter(axis)));
  return columns;
}

double magnitude(const std::array<double, 3>& v) { return std::hypot(v[0], v[1], v[2]); }

/// The force of the spring and the damper on one axis; a wall never pulls.
double axis_force_N(double penetration_m, double velocity_m_s, double stiffness, double damping) {
  if (penetration_m == 0) return 0;
  const double outward = penetration_m > 0 ? 1 : -1;
  // The proxy rests on the wall, so the penetration grows as fast as the probe moves inward.
  return outward * std::max(0.0, stiffness * std::abs(penetration_m) - damping * velocity_m_s * outward);
}

struct Span {
  double smallest = std::numeric_limits<double>::infinity();
  double largest = -std::numeric_limits<double>::infinity();
  void take(double value) {
    smallest = std::min(smallest, value);
    largest = std::max(largest, value);
  }
  double width() const { return largest < smallest ? 0 : largest - smallest; }
};

std::size_t row_at(double time_s, std::size_t rows) {
  const double row = std::round(time_s * protocol::servo_rate_Hz);
  return static_cast<std::size_t>(std::clamp(row, 0.0, static_cast<double>(rows)));
}

}  // namespace

char axis_letter(int axis) { return static_cast<char>('x' + axis); }

Wall parse_wall(const std::string& name) {
  if (name.size() == 2 && name[0] >= 'x' && name[0] <= 'z' && (name[1] == '+' || name[1] == '-'))
    return {name[0] - 'x', name[1] == '+' ? 1 : -1};
  throw device::Error(fmt::format("There is no wall {}. Name one of x-, x+, y-, y+, z-, z+.", name));
}

std::string wall_name(Wall wall) { return {axis_letter(wall.axis), wall.side > 0 ? '+' : '-'}; }

Wall forward_wall(const ParameterSet& parameters) {
  const bool frame_of_omni = parameters[Parameter::frame] == 1.0f;
  return {frame_of_omni ? 2 : 0, 1};
}

double wall_position_m(const ParameterSet& parameters, Wall wall) {
  return static_cast<double>(parameters[wall_parameters[wall.axis][wall.side > 0 ? 1 : 0]]);
}

CurrentStep current_step(const std::vector<double>& reference_A, const std::vector<double>& current_A,
                         double sample_period_s) {
  double largest = 0;
  for (double reference : reference_A)
    if (std::abs(reference) > std::abs(largest)) largest = reference;
  if (largest == 0) throw device::Error("The current test did not reach the motor. Check that the state is ready.");
  const auto is_on = [&](double reference) { return reference / largest > 0.5; };
  const auto begin = std::find_if(reference_A.begin(), reference_A.end(), is_on);
  const auto end = std::find_if_not(begin, reference_A.end(), is_on);
  const auto first = static_cast<std::size_t>(begin - reference_A.begin());
  const auto last = static_cast<std::size_t>(end - reference_A.begin());

  CurrentStep step;
  step.amplitude_A = largest;
  bool risen = false;
  double previous = 0, sum = 0;
  const std::size_t middle = first + (last - first) / 2;
  for (std::size_t i = first; i < last; ++i) {
    const double part = current_A[i] / largest;
    if (!risen && part >= rise_level) {
      const double fraction = part > previous ? (rise_level - previous) / (part - previous) : 1.0;
      step.rise_time_s = std::max(0.0, static_cast<double>(i - first) - 1.0 + fraction) * sample_period_s;
      risen = true;
    }
    previous = part;
    step.overshoot = std::max(step.overshoot, part - 1.0);
    if (i >= middle) sum += current_A[i] - reference_A[i];
  }
  if (!risen)
    throw device::Error("The motor's current does not follow its reference. Check the motor's wiring and supply.");
  step.steady_error_A = sum / static_cast<double>(last - middle);
  return step;
}

ForceLaw force_law(const Recording& recording, const ParameterSet& parameters) {
  const auto penetration = vector_columns(recording, "penetration_{}_m");
  const auto velocity = vector_columns(recording, "velocity_{}_m_s");
  const auto force = vector_columns(recording, "force_{}_N");
  const double stiffness = static_cast<double>(parameters[Parameter::wall_stiffness_N_per_m]);
  const double damping = static_cast<double>(parameters[Parameter::wall_damping_Ns_per_m]);
  const double limit_N = static_cast<double>(parameters[Parameter::force_limit_N]);
  ForceLaw law;
  for (std::size_t i = 0; i < recording.size(); ++i) {
    std::array<double, 3> expected{}, difference{};
    bool in_contact = false;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double penetration_m = recording.at(i, penetration[axis]);
      in_contact |= penetration_m != 0;
      expected[axis] = axis_force_N(penetration_m, recording.at(i, velocity[axis]), stiffness, damping);
    }
    if (!in_contact) continue;
    const double asked_N = magnitude(expected);
    const double scale = asked_N > limit_N ? limit_N / asked_N : 1.0;
    for (std::size_t axis = 0; axis < 3; ++axis)
      difference[axis] = recording.at(i, force[axis]) - scale * expected[axis];
    const double error_N = magnitude(difference), expected_N = scale * asked_N;
    ++law.samples;
    law.error_maximum_N = std::max(law.error_maximum_N, error_N);
    if (expected_N > relative_error_floor_N)
      law.error_maximum_relative = std::max(law.error_maximum_relative, error_N / expected_N);
    law.samples_outside += error_N > std::max(tolerance_N, tolerance_relative * expected_N);
  }
  return law;
}

SteadyHold steady_hold(const Recording& recording, Wall wall, Interval interval) {
  const std::size_t first = row_at(interval.from_s, recording.size()), last = row_at(interval.to_s, recording.size());
  if (first >= last) throw device::Error("The recording ends before the steady hold. Run the experiment again.");
  SteadyHold hold;
  hold.interval = interval;
  for (std::size_t encoder = 0; encoder < 3; ++encoder) {
    const std::size_t column = recording.column(fmt::format("encoder_{}_counts", encoder + 1));
    Span span;
    for (std::size_t i = first; i < last; ++i) span.take(recording.at(i, column));
    hold.encoder_spread_counts[encoder] = span.width();
  }
  const std::size_t position = recording.column(fmt::format("position_{}_m", axis_letter(wall.axis)));
  const std::size_t penetration = recording.column(fmt::format("penetration_{}_m", axis_letter(wall.axis)));
  Span span;
  double sum_m = 0;
  for (std::size_t i = first; i < last; ++i) {
    span.take(recording.at(i, position));
    sum_m += std::abs(recording.at(i, penetration));
  }
  hold.position_spread_m = span.width();
  hold.penetration_mean_m = sum_m / static_cast<double>(last - first);
  return hold;
}

std::optional<Interval> find_steady_hold(const Recording& recording, Wall wall) {
  auto depth_m = recording.values_of(fmt::format("penetration_{}_m", axis_letter(wall.axis)));
  for (double& depth : depth_m) depth = std::abs(depth);
  if (depth_m.empty()) return std::nullopt;
  const double enough_m = *std::max_element(depth_m.begin(), depth_m.end()) / 2;
  const auto rows = static_cast<std::size_t>(hold_duration_s * protocol::servo_rate_Hz);
  const std::size_t step = rows / 25;
  std::optional<Interval> best;
  double best_spread = std::numeric_limits<double>::infinity();
  for (std::size_t first = 0; first + rows <= depth_m.size(); first += step) {
    const auto begin = depth_m.begin() + static_cast<std::ptrdiff_t>(first);
    const auto [least, most] = std::minmax_element(begin, begin + static_cast<std::ptrdiff_t>(rows));
    if (*least == 0 || *least < enough_m || *most - *least >= best_spread) continue;
    best_spread = *most - *least;
    const double from_s = static_cast<double>(first) / protocol::servo_rate_Hz;
    best = Interval{from_s, from_s + hold_duration_s};
  }
  return best;
}

WallResult evaluate(const Recording& recording, const ParameterSet& parameters, Wall wall,
                    std::optional<Interval> hold) {
  WallResult result;
  result.samples = recording.size();
  const std::size_t penetration = recording.column(fmt::format("penetration_{}_m", axis_letter(wall.axis)));
  const std::size_t force = recording.column("force_N"), time = recording.column("time_s");
  const std::size_t torque_1 = recording.column("torque_1_Nm"), torque_2 = recording.column("torque_2_Nm"),
                    torque_3 = recording.column("torque_3_Nm");
  for (std::size_t i = 0; i < recording.size(); ++i) {
    const double depth_m = std::abs(recording.at(i, penetration));
    if (depth_m > 0) {
      ++result.samples_in_contact;
      if (!result.contact) result.contact = Interval{recording.at(i, time), 0};
      result.contact->to_s = recording.at(i, time);
    }
    result.penetration_maximum_m = std::max(result.penetration_maximum_m, depth_m);
    result.force_maximum_N = std::max(result.force_maximum_N, recording.at(i, force));
    result.torque_1_maximum_Nm = std::max(result.torque_1_maximum_Nm, std::abs(recording.at(i, torque_1)));
    result.other_torques_maximum_Nm = std::max(
        {result.other_torques_maximum_Nm, std::abs(recording.at(i, torque_2)), std::abs(recording.at(i, torque_3))});
  }
  result.force_law = force_law(recording, parameters);
  if (!hold) hold = find_steady_hold(recording, wall);
  if (hold) result.steady_hold = steady_hold(recording, wall, *hold);
  return result;
}

}  // namespace inkwell::experiment
