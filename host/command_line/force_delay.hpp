// Delay from a pose to the program's force that answers it, and the frequency response of that force.
#pragma once

#include <vector>

#include <device/device.hpp>

namespace inkwell::command_line {

/// Of a signal, compared with the one that it follows.
struct Transmission {
  double gain = 0;
  double delay_ms = 0;
};

struct Response {
  double frequency_Hz = 0;
  Transmission program_force;  ///< interpolated by the board, compared with what the program computes for the instant
  Transmission current;        ///< measured in motor 1, compared with its reference
};

struct ForceDelay {
  struct Recording {
    double shortest_ms = 0, longest_ms = 0;
  };
  std::vector<Recording> recordings;
  std::vector<Response> responses;
  std::int64_t poses_missed = 0;  ///< by the program, outside of the requests of a recording
};

/// Amplitude of the vibrations, and bound of all forces.
inline constexpr float delay_force_N = 0.5f;

/// The force must be on, and a hand must hold the stylus. Answers each pose with a force along x. Throws
/// device::Error if the force goes off.
ForceDelay measure_force_delay(device::Device& device, int recordings, const std::vector<double>& frequencies_Hz);

}  // namespace inkwell::command_line
