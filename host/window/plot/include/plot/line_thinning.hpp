// Leaves out the points of a line that nobody could see: triangles are what a plot costs without a graphics card.
#pragma once

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace inkwell::window {

/// Takes the points of a line one by one, in pixels, and keeps those at which it bends: no point that was given lies
/// farther from the line that is kept than about `invisible_pixels`. Where the line goes to the left, all are kept
/// but those that hardly differ from the one before.
template <class Point>
class LineThinning {
 public:
  static constexpr float invisible_pixels = 0.2f;

  void add(Point point) {
    if (kept_.empty()) {
      kept_.push_back(point);
      return;
    }
    const Point before = waits_ ? waiting_ : kept_.back();
    if (std::abs(point.x - before.x) < invisible_pixels && std::abs(point.y - before.y) < invisible_pixels) return;
    if (waits_) {
      const float slope = (point.y - kept_.back().y) / (point.x - kept_.back().x);
      // Else a line straight to the new point would pass one of those left out too far away, or miss a turn back.
      if (!(point.x > waiting_.x && lowest_slope_ <= slope && slope <= highest_slope_)) {
        kept_.push_back(waiting_);
        waits_ = false;
      }
    }
    const Point from = kept_.back();
    const float lowest = (point.y - invisible_pixels - from.y) / (point.x - from.x);
    const float highest = (point.y + invisible_pixels - from.y) / (point.x - from.x);
    lowest_slope_ = waits_ ? std::max(lowest_slope_, lowest) : lowest;
    highest_slope_ = waits_ ? std::min(highest_slope_, highest) : highest;
    waiting_ = point;
    waits_ = true;
  }

  /// The points that were kept, the last one included, and starts anew.
  std::vector<Point> take() {
    if (waits_) kept_.push_back(waiting_);
    waits_ = false;
    return std::exchange(kept_, {});
  }

 private:
  std::vector<Point> kept_;
  Point waiting_{};  ///< the newest, not yet known whether the line bends there
  bool waits_ = false;
  float lowest_slope_ = 0, highest_slope_ = 0;  ///< from the last point kept, past all that were left out
};

}  // namespace inkwell::window
