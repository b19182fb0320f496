// Estimates how often a program sends a force. The board interpolates over this time.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

namespace inkwell::library {

/// Intervals are counted in poses, which follow board time. The PC clock is unsuitable, because a busy computer delays
/// threads, and a virtual board runs in simulated time.
class ForceInterval {
 public:
  /// Usual interval between the program's forces in ms: the median of five intervals. A single late force therefore
  /// does not change the median. `pose_sequence` is the sequence of the newest pose that the program had read when it
  /// computed this force.
  int next(std::uint32_t pose_sequence);

 private:
  std::optional<std::uint32_t> sequence_before_;
  std::array<int, 5> newest_ms_{1, 1, 1, 1, 1};
  std::size_t oldest_ = 0;  ///< index of the oldest interval
};

}  // namespace inkwell::library
