#include "host/companion/window/frame/frames_report.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace inkwell::window {

namespace {
constexpr std::size_t pose_ages_maximum = 1'000'000;  // enough for several hours
}

void FramesReport::add(double period_s, double drawing_s, std::optional<double> pose_age_s) {
  ++frames_;
  frames_s_ += period_s;
  drawing_s_ += drawing_s;
  if (!pose_age_s || pose_ages_s_.size() >= pose_ages_maximum) return;
  pose_ages_s_.push_back(*pose_age_s);
  poses_within_a_frame_ += *pose_age_s <= display_period_s_;
}

std::string FramesReport::text() const {
  const auto count = static_cast<double>(std::max<std::uint64_t>(frames_, 1));
  std::string report = fmt::format("{:.1f} frames per second during motion ({:.1f} s), {:.1f} ms to draw a frame\n",
                                   count / std::max(frames_s_, 1e-3), frames_s_, 1000.0 * drawing_s_ / count);
  if (pose_ages_s_.empty()) return report;
  std::vector<double> sorted = pose_ages_s_;
  std::ranges::sort(sorted);
  const auto part_ms = [&sorted](double part) {
    return 1000.0 * sorted[static_cast<std::size_t>(std::lround(part * static_cast<double>(sorted.size() - 1)))];
  };
  report += fmt::format(
      "age of the drawn pose relative to the newest received pose: median {:.0f} ms, 99th percentile {:.0f} ms, "
      "maximum {:.0f} ms; at most one display frame ({:.1f} ms) in {:.2f} % of the frames\n",
      part_ms(0.5), part_ms(0.99), part_ms(1.0), 1000.0 * display_period_s_,
      100.0 * static_cast<double>(poses_within_a_frame_) / static_cast<double>(sorted.size()));
  return report;
}

}  // namespace inkwell::window
