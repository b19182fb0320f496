// Removes points of a line that have no visible effect. Without a graphics card, the drawing time depends on the number
// of triangles.
#pragma once

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace inkwell::window {

/// Keeps the points at which a line bends. The distance between a removed point and the drawn line is at most about
/// `invisible_pixels`. Where x decreases, removes only points close to the previous point.
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
      // Keeps the previous point if a straight line to the new point would omit a bend.
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

  /// Returns the thinned line and starts a new line.
  std::vector<Point> take() {
    if (waits_) kept_.push_back(waiting_);
    waits_ = false;
    return std::exchange(kept_, {});
  }

 private:
  std::vector<Point> kept_;
  Point waiting_{};  ///< newest point, which may still be removed
  bool waits_ = false;
  float lowest_slope_ = 0, highest_slope_ = 0;  ///< range of slopes from the last kept point that passes all removed
                                                ///< points
};

}  // namespace inkwell::window
