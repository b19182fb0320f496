// Estimates the interval between a program's forces. The board interpolates the force over this interval.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

namespace inkwell::library {

/// Intervals are counted in poses, which follow board time. The PC clock does not follow the simulated time of a
/// virtual board.
class ForceInterval {
 public:
  /// Returns the median of the last five intervals in ms. `pose_sequence` belongs to the pose from which the program
  /// computed the force.
  int next(std::uint32_t pose_sequence);

 private:
  std::optional<std::uint32_t> sequence_before_;
  std::array<int, 5> newest_ms_{1, 1, 1, 1, 1};
  std::size_t oldest_ = 0;  ///< index of the oldest interval
};

}  // namespace inkwell::library
