// How often a program sends a force: the board interpolates over this time.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

namespace inkwell::library {

/// Counts in poses, which follow the bus and therefore board time. The PC's clock says nothing about them: a busy
/// computer delays threads, and a virtual board has a time of its own.
class ForceInterval {
 public:
  /// The program's usual time from one force to the next, ms. `pose_sequence` is that of the newest pose that the
  /// program had seen when it computed this force. The median of five, so that one late force changes nothing.
  int next(std::uint32_t pose_sequence);

 private:
  std::optional<std::uint32_t> sequence_before_;
  std::array<int, 5> newest_ms_{1, 1, 1, 1, 1};
  std::size_t oldest_ = 0;  ///< in the list
};

}  // namespace inkwell::library
