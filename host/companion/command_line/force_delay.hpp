// Measures the delay from a pose to the program's force, and the frequency response of the program's force.
#pragma once

#include <vector>

#include "host/client/device/device.hpp"

namespace inkwell::command_line {

/// Gain and delay of a signal relative to its reference.
struct Transmission {
  double gain = 0;
  double delay_ms = 0;
};

struct Response {
  double frequency_Hz = 0;
  Transmission program_force;  ///< interpolated force on the board, relative to the force that the program computes for
                               ///< the same time
  Transmission current;        ///< current measured in motor 1, relative to its reference
};

struct ForceDelay {
  struct Recording {
    double shortest_ms = 0, longest_ms = 0;
  };
  std::vector<Recording> recordings;
  std::vector<Response> responses;
  std::int64_t poses_missed = 0;  ///< missed by the program, except during requests
};

/// Largest force of the measurement.
inline constexpr float delay_force_N = 0.5f;

/// The force must be on, and a hand must hold the stylus. Answers each pose with a force along x. Throws device::Error
/// if the board switches the force off.
ForceDelay measure_force_delay(device::Device& device, int recordings, const std::vector<double>& frequencies_Hz);

}  // namespace inkwell::command_line
