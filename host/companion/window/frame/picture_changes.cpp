#include "host/companion/window/frame/picture_changes.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace inkwell::window {

namespace {

Box change_of(const DrawnPane& before, const DrawnPane& now) {
  Box change;
  for (std::size_t i = 0; i < std::max(before.parts.size(), now.parts.size()); ++i) {
    const DrawnPart was = i < before.parts.size() ? before.parts[i] : DrawnPart{};
    const DrawnPart is = i < now.parts.size() ? now.parts[i] : DrawnPart{};
    if (was == is) continue;
    change = enclosing(change, enclosing(was.box, is.box));
  }
  return change;
}

std::vector<Box> without_overlap(std::vector<Box> boxes) {
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    const auto overlapping = std::find_if(boxes.begin() + static_cast<std::ptrdiff_t>(i) + 1, boxes.end(),
                                          [&](const Box& other) { return !common(boxes[i], other).is_empty(); });
    if (overlapping == boxes.end()) continue;
    boxes[i] = enclosing(boxes[i], *overlapping);
    boxes.erase(overlapping);
    i = static_cast<std::size_t>(-1);  // the enlarged box may overlap previous boxes
  }
  return boxes;
}

bool are_same_panes(const DrawnPicture& before, const DrawnPicture& now) {
  return std::ranges::equal(before.panes, now.panes, {}, &DrawnPane::pane, &DrawnPane::pane);
}

}  // namespace

Box common(const Box& a, const Box& b) {
  return {std::max(a.left, b.left), std::max(a.top, b.top), std::min(a.right, b.right), std::min(a.bottom, b.bottom)};
}

Box enclosing(const Box& a, const Box& b) {
  if (a.is_empty()) return b;
  if (b.is_empty()) return a;
  return {std::min(a.left, b.left), std::min(a.top, b.top), std::max(a.right, b.right), std::max(a.bottom, b.bottom)};
}

std::vector<Box> changes_between(const DrawnPicture& before, const DrawnPicture& now) {
  if (before.window != now.window || before.width_pixels != now.width_pixels ||
      before.height_pixels != now.height_pixels || before.ground != now.ground || before.canvas != now.canvas ||
      !are_same_panes(before, now))
    return {now.window};
  std::vector<Box> boxes;
  if (before.canvas_digest != now.canvas_digest) boxes.push_back(now.canvas);
  for (std::size_t i = 0; i < now.panes.size(); ++i) {
    const Box change = change_of(before.panes[i], now.panes[i]);
    if (change.is_empty()) continue;
    // The box includes an extra pixel for the antialiased edges of triangles.
    const Box whole_pixels{std::floor(change.left) - 1, std::floor(change.top) - 1, std::ceil(change.right) + 1,
                           std::ceil(change.bottom) + 1};
    boxes.push_back(common(whole_pixels, now.window));
  }
  const auto is_cut = [&](const Box& box) {
    return !common(box, now.canvas).is_empty() && enclosing(box, now.canvas) != box;
  };
  for (boxes = without_overlap(boxes); std::ranges::any_of(boxes, is_cut); boxes = without_overlap(boxes))
    for (Box& box : boxes)
      if (is_cut(box)) box = enclosing(box, now.canvas);
  return boxes;
}

}  // namespace inkwell::window
