// A quadrature encoder on a motor. The model derives counts from the joint angle and changes one output at a time.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "boards/virtual/plant/encoder_fault.hpp"

namespace inkwell::virtual_board {

class QuadratureEncoder {
 public:
  struct Levels {
    bool a, b;
    bool operator==(const Levels&) const = default;
  };

  /// A negative `counts_per_rad` means that the encoder counts down when its joint turns forward.
  explicit QuadratureEncoder(double counts_per_rad, double joint_rad, std::uint64_t seed = 1)
      : fault(seed),
        counts_per_rad_(counts_per_rad),
        shown_at_(joint_rad * counts_per_rad),
        reached_(count_at(joint_rad)) {}

  /// Returns the disc count, which is 0 at joint angle 0.
  std::int64_t count_at(double joint_rad) const {
    return static_cast<std::int64_t>(std::floor(joint_rad * counts_per_rad_));
  }
  /// Disc count minus the lost counts.
  std::int64_t shown() const { return reached_ - lost_; }

  /// Both outputs at `count`. A leads B while counting up (RM0090, "Encoder interface mode").
  static Levels levels(std::int64_t count) {
    const auto phase = static_cast<unsigned>(count & 3);
    return {phase == 1 || phase == 2, phase >= 2};
  }

  /// Moves to the count at `joint_rad` and calls `edge(levels, share)` for each passed count. `share` is the completed
  /// fraction of the motion.
  template <class Edge>
  void follow(double joint_rad, Edge&& edge) {
    slipped_ += fault.slipped_counts();
    const double from = shown_at_, way = joint_rad * counts_per_rad_ + slipped_ - from;
    shown_at_ += way;
    const auto target = static_cast<std::int64_t>(std::floor(shown_at_));
    while (reached_ != target) {
      const bool up = target > reached_;
      const auto border = static_cast<double>(up ? reached_ + 1 : reached_);
      reached_ += up ? 1 : -1;
      if (fault.swallows())
        lost_ += up ? 1 : -1;
      else
        edge(levels(shown()), std::clamp((border - from) / way, 0.0, 1.0));
    }
  }

  EncoderFault fault;

 private:
  double counts_per_rad_;
  double shown_at_;  ///< position of the disc in counts
  double slipped_ = 0.0;
  std::int64_t reached_, lost_ = 0;
};

}  // namespace inkwell::virtual_board
