// Measures latency and loss of a program's forces.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>

namespace inkwell::virtual_usb_test {

struct ForceTiming {
  /// Number of report intervals per class of deviation from one millisecond. The middle class counts intervals without
  /// a deviation. The other classes have bounds of 1, 3, 10 and 30 us on both sides.
  static constexpr std::array<double, 4> deviation_bounds_us{1, 3, 10, 30};
  std::array<std::uint64_t, 2 * deviation_bounds_us.size() + 1> deviations{};

  std::uint64_t sent = 0;
  std::uint64_t lost = 0;  ///< counted by the device, like the next three
  std::uint64_t late = 0;
  std::uint64_t refused = 0;
  std::uint64_t received = 0;
  std::uint64_t samples = 0;                 ///< observed control periods
  double longest_pose_to_force_periods = 0;  ///< from the control period of a pose to the control period that uses its
                                             ///< force
};

/// Runs a program for `time_s` of board time. The program immediately answers each pose with a force that is computed
/// from this pose.
ForceTiming measure_forces(const std::filesystem::path& image, double host_clock_ppm, double time_s);

}  // namespace inkwell::virtual_usb_test
