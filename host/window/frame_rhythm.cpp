#include <window/frame_rhythm.hpp>

#include <algorithm>
#include <cmath>

namespace inkwell::window {

bool FrameRhythm::is_due(bool something_happened, double now_s) const {
  return something_happened || is_lively(now_s) || now_s - laid_out_s_ >= resting_period_s;
}

bool FrameRhythm::is_to_be_drawn(const FrameEvidence& evidence, double now_s) {
  laid_out_s_ = now_s;
  if (evidence.input || evidence.moves) lively_until_s_ = now_s + lively_for_s;
  return evidence.moves || evidence.differs;
}

bool looks_different(const std::optional<protocol::PoseReport>& first,
                     const std::optional<protocol::PoseReport>& second) {
  if (!first || !second) return first.has_value() != second.has_value();
  const protocol::PoseReport& a = *first;
  const protocol::PoseReport& b = *second;
  constexpr float visible_m = 2e-4f;
  constexpr float visible_N = 0.02f;
  constexpr float visible_rad = 0.02f;
  if (a.state != b.state || a.fault != b.fault || a.switches != b.switches) return true;
  for (int i = 0; i < 3; ++i)
    if (std::abs(a.position_m[i] - b.position_m[i]) > visible_m || std::abs(a.force_N[i] - b.force_N[i]) > visible_N ||
        std::abs(a.gimbal_rad[i] - b.gimbal_rad[i]) > visible_rad)
      return true;
  return false;
}

bool leaves_range(Extremes newest, Extremes before, double value_of_a_pixel) {
  // The extremes of a few thousand samples of noise hardly ever exceed those of some ten thousand by this part.
  constexpr float noise_part = 0.25f;
  const float margin = std::max(static_cast<float>(value_of_a_pixel), noise_part * (before.maximum - before.minimum));
  return newest.minimum < before.minimum - margin || newest.maximum > before.maximum + margin;
}

}  // namespace inkwell::window
