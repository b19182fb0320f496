// How old poses are when the host gets them, and whether every frame of the host brings one.
#pragma once

#include <cstdint>
#include <filesystem>

namespace inkwell::virtual_usb_test {

/// Times are in processor cycles of board time.
struct PoseTiming {
  std::uint64_t frames = 0;                  ///< in which the host asked
  std::uint64_t empty_frames = 0;            ///< of them without a new pose
  std::uint64_t gaps = 0;                    ///< reports missing by their sequence
  std::uint64_t edges = 0;                   ///< of an encoder
  std::uint64_t longest_edge_to_token = 0;   ///< from an edge to the IN token whose packet shows it
  std::uint64_t longest_edge_to_packet = 0;  ///< to the end of that packet
  std::uint64_t longest_pause_periods = 0;   ///< between the control periods of two reports
};

enum class Beside { nothing, storm_of_parameters };

/// Lets the firmware run for `time_s` of board time against a host whose clock is so much faster than board time, and
/// which also reads so many signals of the scope; in a storm it sets all parameters, again and again.
PoseTiming measure_poses(const std::filesystem::path& image, double host_clock_ppm, double time_s,
                         std::uint8_t scope_signals, Beside beside = Beside::nothing);

}  // namespace inkwell::virtual_usb_test
