// How long a program's force is on its way, and whether every one arrives.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>

namespace inkwell::virtual_usb_test {

struct ForceTiming {
  /// By how much the time from one report to the next differs from a millisecond of the host: in the middle not at all,
  /// beside it up to 1, 3, 10, 30 us and more, sooner and later.
  static constexpr std::array<double, 4> deviation_bounds_us{1, 3, 10, 30};
  std::array<std::uint64_t, 2 * deviation_bounds_us.size() + 1> deviations{};

  std::uint64_t sent = 0;
  std::uint64_t lost = 0;  ///< as the device counted, like the next three
  std::uint64_t late = 0;
  std::uint64_t refused = 0;
  std::uint64_t received = 0;
  std::uint64_t samples = 0;                 ///< control periods that were looked at
  double longest_pose_to_force_periods = 0;  ///< from the control period of a pose to the one that has its force
};

/// A program that answers each pose at once with a force that depends on it, for `time_s` of board time.
ForceTiming measure_forces(const std::filesystem::path& image, double host_clock_ppm, double time_s);

}  // namespace inkwell::virtual_usb_test
