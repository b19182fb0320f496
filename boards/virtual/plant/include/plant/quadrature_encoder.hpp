// A quadrature encoder on a motor: counts from the motor's angle, edges one pin at a time.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace inkwell::virtual_board {

class QuadratureEncoder {
 public:
  struct Levels {
    bool a, b;
    bool operator==(const Levels&) const = default;
  };

  /// `counts_per_rad` is signed: negative if the encoder counts down while its joint turns forward.
  explicit QuadratureEncoder(double counts_per_rad, double joint_rad)
      : counts_per_rad_(counts_per_rad), shown_at_(joint_rad * counts_per_rad), shown_(count_at(joint_rad)) {}

  /// Counts of the disc at this joint angle; zero is where the joint's angle is zero.
  std::int64_t count_at(double joint_rad) const {
    return static_cast<std::int64_t>(std::floor(joint_rad * counts_per_rad_));
  }
  std::int64_t shown() const { return shown_; }

  /// Both outputs at `count`. A leads B while counting up (RM0090, "Encoder interface mode").
  static Levels levels(std::int64_t count) {
    const auto phase = static_cast<unsigned>(count & 3);
    return {phase == 1 || phase == 2, phase >= 2};
  }

  /// Moves to the count at `joint_rad`, calling `edge(levels, share)` for each count on the way, at which that share of
  /// the way is behind it.
  template <class Edge>
  void follow(double joint_rad, Edge&& edge) {
    const std::int64_t target = count_at(joint_rad);
    const double from = shown_at_, way = joint_rad * counts_per_rad_ - from;
    shown_at_ += way;
    while (shown_ != target) {
      const bool up = target > shown_;
      const auto border = static_cast<double>(up ? shown_ + 1 : shown_);
      shown_ += up ? 1 : -1;
      edge(levels(shown_), std::clamp((border - from) / way, 0.0, 1.0));
    }
  }

 private:
  double counts_per_rad_;
  double shown_at_;  ///< where the disc stands, in counts
  std::int64_t shown_;
};

}  // namespace inkwell::virtual_board
