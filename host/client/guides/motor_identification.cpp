#include "host/client/guides/motor_identification.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Dense>

#include "host/client/device/error.hpp"

namespace inkwell::guides {
namespace {

/// The fit uses the second to the last sample of a pulse.
struct Segment {
  const VoltagePulse* pulse;
  std::size_t begin;  ///< of the pulse: the first period with voltage
  std::size_t first, last;
};

constexpr std::size_t settled_after = 2;  // periods until a voltage certainly acts for a full period
constexpr std::size_t shortest = 20;      // periods, about nine time constants of a small motor

Segment find_segment(const VoltagePulse& pulse) {
  const auto& voltage = pulse.voltage_V;
  const auto largest = std::ranges::max_element(voltage, {}, [](double v) { return std::abs(v); });
  if (largest == voltage.end() || *largest == 0)
    throw device::Error("The voltage pulse did not reach the motor. Check that the state is ready.");
  const auto is_on = [&](double v) { return v / *largest > 0.5; };
  const auto begin = std::ranges::find_if(voltage, is_on);
  const auto end = std::find_if_not(begin, voltage.end(), is_on);
  const auto first = static_cast<std::size_t>(begin - voltage.begin());
  const auto last = static_cast<std::size_t>(end - voltage.begin());
  if (last - first < shortest + settled_after)
    throw device::Error(
        "The voltage pulse is too short to identify the motor. A small energy_reserve_J or force_limit_N shortens the "
        "pulse: increase them. Then start the guide again, and hold the stylus still.");
  return {&pulse, first, first + settled_after, last};
}

/// Unknowns: logarithms of resistance and time constant (both are positive), dead-time voltage, first currents.
struct Model {
  const std::vector<Segment>& segments;
  double period_s, ripple_A;

  Eigen::VectorXd currents(const Eigen::VectorXd& unknowns, Eigen::Index count) const {
    const double resistance = std::exp(unknowns[0]);
    const double decay = std::exp(-period_s / std::exp(unknowns[1]));
    Eigen::VectorXd result(count);
    Eigen::Index at = 0;
    for (std::size_t s = 0; s < segments.size(); ++s) {
      const Segment& segment = segments[s];
      double current_A = unknowns[3 + static_cast<Eigen::Index>(s)];
      for (std::size_t k = segment.first; k < segment.last; ++k) {
        result[at++] = current_A;
        const double lost_V = unknowns[2] * std::clamp(current_A / ripple_A, -1.0, 1.0);
        const double final_A = (segment.pulse->voltage_V[k] - segment.pulse->back_emf_V[k] - lost_V) / resistance;
        current_A = final_A + (current_A - final_A) * decay;
      }
    }
    return result;
  }
};

Eigen::MatrixXd derivatives(const Model& model, const Eigen::VectorXd& unknowns, const Eigen::VectorXd& at) {
  constexpr double change = 1e-6;
  Eigen::MatrixXd jacobian(at.size(), unknowns.size());
  for (Eigen::Index i = 0; i < unknowns.size(); ++i) {
    Eigen::VectorXd moved = unknowns;
    moved[i] += change;
    jacobian.col(i) = (model.currents(moved, at.size()) - at) / change;
  }
  return jacobian;
}

/// Levenberg damping limits the first steps to the region in which the exponential is meaningful.
Eigen::VectorXd fit(const Model& model, Eigen::VectorXd unknowns, const Eigen::VectorXd& measured) {
  double damping = 1e-3;
  Eigen::VectorXd fitted = model.currents(unknowns, measured.size());
  double error = (measured - fitted).squaredNorm();
  for (int round = 0; round < 60; ++round) {
    const Eigen::MatrixXd jacobian = derivatives(model, unknowns, fitted);
    Eigen::MatrixXd normal = jacobian.transpose() * jacobian;
    normal.diagonal() *= 1.0 + damping;
    const Eigen::VectorXd step = normal.ldlt().solve(jacobian.transpose() * (measured - fitted));
    const Eigen::VectorXd next = model.currents(unknowns + step, measured.size());
    const double next_error = (measured - next).squaredNorm();
    if (!(next_error <= error)) {
      damping *= 10;
      if (damping > 1e6) break;
      continue;
    }
    const bool converged = step.cwiseAbs().maxCoeff() < 1e-9 || error - next_error < 1e-12 * error;
    unknowns += step;
    fitted = next;
    error = next_error;
    damping = std::max(damping / 10, 1e-9);
    if (converged) break;
  }
  return unknowns;
}

double mean_of_second_half(const std::vector<double>& values, const Segment& segment) {
  const std::size_t middle = (segment.first + segment.last) / 2;
  double sum = 0;
  for (std::size_t k = middle; k < segment.last; ++k) sum += values[k];
  return sum / static_cast<double>(segment.last - middle);
}

/// Delay until the voltage acted, computed from the first current of the segment.
double delay_of(const Segment& segment, double first_current_A, double final_A, double time_constant_s,
                double period_s) {
  const double part = std::clamp(first_current_A / final_A, 0.0, 0.999);
  const double acting_s = -time_constant_s * std::log(1.0 - part);
  return static_cast<double>(segment.first - segment.begin) * period_s - acting_s;
}

}  // namespace

MotorCircuit identify(const std::vector<VoltagePulse>& pulses, double sample_period_s, double ripple_A) {
  std::vector<Segment> segments;
  Eigen::Index count = 0;
  for (const auto& pulse : pulses) {
    segments.push_back(find_segment(pulse));
    count += static_cast<Eigen::Index>(segments.back().last - segments.back().first);
  }
  if (segments.empty()) throw device::Error("There is no pulse to identify the motor from. Start the guide again.");

  Eigen::VectorXd measured(count), unknowns(3 + static_cast<Eigen::Index>(segments.size()));
  Eigen::Index at = 0;
  double resistance = 0;
  for (std::size_t s = 0; s < segments.size(); ++s) {
    const Segment& segment = segments[s];
    for (std::size_t k = segment.first; k < segment.last; ++k) measured[at++] = segment.pulse->current_A[k];
    const double current_A = mean_of_second_half(segment.pulse->current_A, segment);
    const double voltage_V = mean_of_second_half(segment.pulse->voltage_V, segment);
    constexpr double least_A_per_V = 1.0 / 100.0;  // a larger resistance counts as an open circuit
    if (current_A / voltage_V < -least_A_per_V)
      throw device::Error(
          "The measured motor current has the wrong sign. Check the wiring of the current sensor and of the bridge.");
    if (!(current_A / voltage_V > least_A_per_V))
      throw device::Error("No current flows in the motor. Check its plug, its wiring and the supply of the bridges.");
    resistance += voltage_V / current_A / static_cast<double>(segments.size());
    unknowns[3 + static_cast<Eigen::Index>(s)] = segment.pulse->current_A[segment.first];
  }
  unknowns[0] = std::log(resistance);
  unknowns[1] = std::log(2 * sample_period_s);
  unknowns[2] = 0;

  const Model model{segments, sample_period_s, ripple_A};
  unknowns = fit(model, unknowns, measured);
  const double time_constant_s = std::exp(unknowns[1]);
  MotorCircuit circuit;
  circuit.resistance_ohm = std::exp(unknowns[0]);
  circuit.inductance_H = circuit.resistance_ohm * time_constant_s;
  circuit.dead_time_voltage_V = unknowns[2];
  circuit.residual_A =
      std::sqrt((measured - model.currents(unknowns, count)).squaredNorm() / static_cast<double>(count));
  for (std::size_t s = 0; s < segments.size(); ++s) {
    const double final_A = mean_of_second_half(segments[s].pulse->current_A, segments[s]);
    circuit.delay_s +=
        delay_of(segments[s], unknowns[3 + static_cast<Eigen::Index>(s)], final_A, time_constant_s, sample_period_s) /
        static_cast<double>(segments.size());
  }
  const double largest_A = measured.cwiseAbs().maxCoeff();
  const bool plausible = std::isfinite(circuit.resistance_ohm) && time_constant_s > 0.1 * sample_period_s &&
                         time_constant_s < 100 * sample_period_s && circuit.residual_A < 0.1 * largest_A;
  if (!plausible)
    throw device::Error(
        "The current does not rise as in a coil with a resistance. Check the motor's wiring and plug, hold the arm "
        "still, and start the guide again.");
  return circuit;
}

SuggestedGains suggest_gains(const MotorCircuit& motor, double bandwidth_Hz) {
  const double bandwidth_rad_s = 2 * std::numbers::pi * bandwidth_Hz;
  return {motor.inductance_H * bandwidth_rad_s, motor.resistance_ohm * bandwidth_rad_s};
}

double phase_margin_deg(double bandwidth_Hz, double delay_s) { return 90.0 - 360.0 * bandwidth_Hz * delay_s; }

}  // namespace inkwell::guides
