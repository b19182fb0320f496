// Velocity from positions, for programs that have poses only.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace inkwell::kinematics {

/// The slope of the straight line that fits the newest positions best. Over 8 ms an encoder's step of 0.03 mm is a
/// hundredth of a metre a second at most, and the velocity is 4 ms old.
class VelocityFit {
 public:
  static constexpr double span_s = 0.008;

  /// `time_s` must not fall; after a gap longer than the span, or when it falls, the fit starts anew.
  void add(double time_s, const std::array<double, 3>& position_m);
  /// 0 until there are two positions.
  std::array<double, 3> velocity_m_s() const;

 private:
  struct Sample {
    double time_s;
    std::array<double, 3> position_m;
  };
  static constexpr std::size_t capacity = 16;
  std::array<Sample, capacity> samples_{};
  std::size_t count_ = 0;  ///< the newest is the last
};

}  // namespace inkwell::kinematics
