#include "host/lab/experiment/summary.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "protocol/reports.hpp"

namespace inkwell::experiment {
namespace {

using protocol::Parameter;
using protocol::ParameterSet;
using protocol::Signal;
using recording::Recording;

constexpr double relative_error_floor_N = 0.5;
constexpr double tolerance_N = 0.005, tolerance_relative = 0.01;
constexpr double hold_duration_s = 0.5;

/// Columns of the three components of a vector.
std::array<const std::vector<float>*, 3> vector_columns(const Recording& recording, protocol::EachAxis<Signal> rows) {
  return {&recording.column(rows[0]), &recording.column(rows[1]), &recording.column(rows[2])};
}

double magnitude(const std::array<double, 3>& v) { return std::hypot(v[0], v[1], v[2]); }

/// Returns the wall force on one axis. A wall only pushes.
double axis_force_N(double penetration_m, double velocity_m_s, double stiffness, double damping) {
  if (penetration_m == 0) return 0;
  const double outward = penetration_m > 0 ? 1 : -1;
  // The proxy rests on the wall, so the penetration rate equals the inward speed of the probe.
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

ForceLawError force_law_error(const Recording& recording, const ParameterSet& parameters) {
  const auto penetration = vector_columns(recording, Signal::penetration_x_m);
  const auto velocity = vector_columns(recording, Signal::velocity_x_m_s);
  const auto force = vector_columns(recording, Signal::force_x_N);
  const double stiffness = static_cast<double>(parameters[Parameter::wall_stiffness_N_per_m]);
  const double damping = static_cast<double>(parameters[Parameter::wall_damping_Ns_per_m]);
  const double limit_N = static_cast<double>(parameters[Parameter::force_limit_N]);
  ForceLawError error;
  for (std::size_t i = 0; i < recording.size(); ++i) {
    std::array<double, 3> expected{}, difference{};
    bool in_contact = false;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double penetration_m = (*penetration[axis])[i];
      in_contact |= penetration_m != 0;
      expected[axis] = axis_force_N(penetration_m, (*velocity[axis])[i], stiffness, damping);
    }
    if (!in_contact) continue;
    const double requested_N = magnitude(expected);
    const double scale = requested_N > limit_N ? limit_N / requested_N : 1.0;
    for (std::size_t axis = 0; axis < 3; ++axis) difference[axis] = (*force[axis])[i] - scale * expected[axis];
    const double error_N = magnitude(difference), expected_N = scale * requested_N;
    ++error.samples;
    error.maximum_N = std::max(error.maximum_N, error_N);
    if (expected_N > relative_error_floor_N)
      error.maximum_relative = std::max(error.maximum_relative, error_N / expected_N);
    error.samples_outside += error_N > std::max(tolerance_N, tolerance_relative * expected_N);
  }
  return error;
}

SteadyHold steady_hold(const Recording& recording, BoxWall wall, Interval interval) {
  const std::size_t first = row_at(interval.from_s, recording.size()), last = row_at(interval.to_s, recording.size());
  if (first >= last) throw device::Error("The recording ends before the steady hold. Run the experiment again.");
  SteadyHold hold;
  hold.interval = interval;
  for (int encoder = 0; encoder < 3; ++encoder) {
    const auto& counts = recording.column(of_axis(Signal::encoder_1_counts, encoder));
    Span span;
    for (std::size_t i = first; i < last; ++i) span.take(counts[i]);
    hold.encoder_spread_counts[static_cast<std::size_t>(encoder)] = span.width();
  }
  const auto& position_m = recording.column(of_axis(Signal::position_x_m, wall.axis));
  const auto& penetration_m = recording.column(of_axis(Signal::penetration_x_m, wall.axis));
  Span span;
  double sum_m = 0;
  for (std::size_t i = first; i < last; ++i) {
    span.take(position_m[i]);
    sum_m += std::abs(static_cast<double>(penetration_m[i]));
  }
  hold.position_spread_m = span.width();
  hold.penetration_mean_m = sum_m / static_cast<double>(last - first);
  return hold;
}

std::optional<Interval> find_steady_hold(const Recording& recording, BoxWall wall) {
  auto depth_m = recording.column(of_axis(Signal::penetration_x_m, wall.axis));
  for (float& depth : depth_m) depth = std::abs(depth);
  if (depth_m.empty()) return std::nullopt;
  const float enough_m = *std::max_element(depth_m.begin(), depth_m.end()) / 2;
  const auto rows = static_cast<std::size_t>(hold_duration_s * protocol::servo_rate_Hz);
  const std::size_t step = rows / 25;
  std::optional<Interval> best;
  float best_spread = std::numeric_limits<float>::infinity();
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

std::optional<Interval> contact_with(const recording::StoredRecording& recording, BoxWall wall) {
  constexpr std::size_t range_samples = 65'536;
  const std::size_t column = recording.column_of(of_axis(Signal::penetration_x_m, wall.axis));
  std::vector<recording::SampleRange> ranges;
  for (std::size_t begin = 0; begin < recording.size(); begin += range_samples)
    ranges.push_back({begin, std::min(recording.size(), begin + range_samples)});
  const auto bands = recording.bands({&column, 1}, ranges);
  const auto has_contact = [](const std::vector<recording::Band>& range) {
    return range.front().minimum != 0 || range.front().maximum != 0;
  };
  const auto first = std::ranges::find_if(bands, has_contact);
  if (first == bands.end()) return std::nullopt;
  const auto last = std::find_if(bands.rbegin(), bands.rend(), has_contact);
  const auto samples_of = [&](std::ptrdiff_t index) {
    const auto [begin, end] = ranges[static_cast<std::size_t>(index)];
    std::vector<float> penetration_m(end - begin);
    recording.read(column, begin, penetration_m);
    return std::pair(begin, std::move(penetration_m));
  };
  const auto touches = [](float penetration_m) { return penetration_m != 0; };
  const auto [first_begin, first_m] = samples_of(first - bands.begin());
  const auto [last_begin, last_m] = samples_of(bands.rend() - last - 1);
  const auto touch = std::ranges::find_if(first_m, touches);
  const auto release = std::find_if(last_m.rbegin(), last_m.rend(), touches);
  return Interval{recording.elapsed_s(first_begin + static_cast<std::size_t>(touch - first_m.begin())),
                  recording.elapsed_s(last_begin + static_cast<std::size_t>(last_m.rend() - release) - 1)};
}

WallResult evaluate(const Recording& recording, const ParameterSet& parameters, BoxWall wall,
                    std::optional<Interval> hold) {
  WallResult result;
  result.samples = recording.size();
  result.samples_lost = recording.lost();
  const auto& penetration_m = recording.column(of_axis(Signal::penetration_x_m, wall.axis));
  const auto& force_N = recording.column(Signal::force_N);
  const auto torque_Nm = vector_columns(recording, Signal::torque_1_Nm);
  const auto grow = [](double& largest, float value) {
    largest = std::max(largest, std::abs(static_cast<double>(value)));
  };
  for (std::size_t i = 0; i < recording.size(); ++i) {
    if (penetration_m[i] != 0) {
      ++result.samples_in_contact;
      if (!result.contact) result.contact = Interval{recording.elapsed_s(i), 0};
      result.contact->to_s = recording.elapsed_s(i);
    }
    grow(result.penetration_maximum_m, penetration_m[i]);
    grow(result.force_maximum_N, force_N[i]);
    grow(result.torque_1_maximum_Nm, (*torque_Nm[0])[i]);
    grow(result.other_torques_maximum_Nm, (*torque_Nm[1])[i]);
    grow(result.other_torques_maximum_Nm, (*torque_Nm[2])[i]);
  }
  result.force_law_error = force_law_error(recording, parameters);
  if (!hold) hold = find_steady_hold(recording, wall);
  if (hold) result.steady_hold = steady_hold(recording, wall, *hold);
  return result;
}

}  // namespace inkwell::experiment
