#include "host/companion/window/frame/frame_rhythm.hpp"

#include <algorithm>

namespace inkwell::window {

bool FrameRhythm::is_due(bool something_happened, double now_s) const {
  return something_happened || is_lively(now_s) || now_s - laid_out_s_ >= resting_period_now_s_;
}

void FrameRhythm::took(double drawing_s) {
  resting_period_now_s_ = std::clamp(drawing_s / resting_share, resting_period_s, resting_period_maximum_s);
}

bool FrameRhythm::record_evidence(const FrameEvidence& evidence, double now_s) {
  laid_out_s_ = now_s;
  if (evidence.input || evidence.moves) lively_until_s_ = now_s + lively_for_s;
  return evidence.moves || evidence.differs;
}

}  // namespace inkwell::window
