// Velocity from positions, for programs that have only poses.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace inkwell::kinematics {

/// Slope of the least-squares line through the newest positions. With a span of 8 ms, an encoder step of 0.03 mm
/// changes the velocity by at most 0.01 m/s. The velocity is delayed by 4 ms.
class VelocityFit {
 public:
  static constexpr double span_s = 0.008;

  /// The fit restarts if `time_s` decreases, or after a gap longer than the span.
  void add(double time_s, const std::array<double, 3>& position_m);
  /// Returns 0 until there are two positions.
  std::array<double, 3> velocity_m_s() const;

 private:
  struct Sample {
    double time_s;
    std::array<double, 3> position_m;
  };
  static constexpr std::size_t capacity = 16;
  std::array<Sample, capacity> samples_{};
  std::size_t count_ = 0;  ///< the newest sample is the last
};

}  // namespace inkwell::kinematics
