// Encoder faults: a stuck disc, lost counts and a slipping disc.
#pragma once

#include <algorithm>
#include <cstdint>
#include <random>

namespace inkwell::virtual_board {

class EncoderFault {
 public:
  explicit EncoderFault(std::uint64_t seed) : random_(static_cast<std::uint32_t>(seed) + 1) {}

  void set_stuck(bool stuck) { is_stuck_ = stuck; }
  void lose(double share) { lost_share_ = share; }
  void slip(double counts) { to_slip_ += counts; }

  /// Returns true if the encoder omits the edge of the next count.
  bool swallows() {
    return is_stuck_ || (lost_share_ > 0.0 && std::generate_canonical<double, 32>(random_) < lost_share_);
  }
  /// Returns the slip of the disc in this step. The slip rate is limited, so that the chip's input filters pass all
  /// edges.
  double slipped_counts() {
    constexpr double fastest = 20.0;
    const double now = std::clamp(to_slip_, -fastest, fastest);
    to_slip_ -= now;
    return now;
  }

 private:
  bool is_stuck_ = false;
  double lost_share_ = 0.0;
  double to_slip_ = 0.0;
  std::minstd_rand random_;
};

}  // namespace inkwell::virtual_board
