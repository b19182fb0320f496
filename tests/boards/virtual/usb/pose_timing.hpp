// Measures the age of the poses at the host, and counts the frames without a new pose.
#pragma once

#include <cstdint>
#include <filesystem>

namespace inkwell::virtual_usb_test {

/// Times are in processor cycles of board time.
struct PoseTiming {
  std::uint64_t frames = 0;                  ///< frames in which the host requested a pose
  std::uint64_t empty_frames = 0;            ///< frames without a new pose
  std::uint64_t gaps = 0;                    ///< missing sequence numbers
  std::uint64_t edges = 0;                   ///< encoder edges
  std::uint64_t longest_edge_to_token = 0;   ///< from an edge to the IN token whose packet contains the edge
  std::uint64_t longest_edge_to_packet = 0;  ///< from an edge to the end of this packet
  std::uint64_t longest_pause_periods = 0;   ///< between the control periods of two reports
};

enum class Beside { nothing, storm_of_parameters };

/// Runs the firmware for `time_s` of board time. The host's clock deviates by `host_clock_ppm`, and the host reads
/// `scope_signals` signals in parallel. With `storm_of_parameters`, the host sets all parameters repeatedly.
PoseTiming measure_poses(const std::filesystem::path& image, double host_clock_ppm, double time_s,
                         std::uint8_t scope_signals, Beside beside = Beside::nothing);

}  // namespace inkwell::virtual_usb_test
