// Where a picture differs from the one before it. Only this is drawn anew: most of a window stays as it is while a
// signal scrolls through a plot, and without a graphics card every pixel costs time.
#pragma once

#include <cstdint>
#include <vector>

namespace inkwell::window {

/// A part of the window, in screen coordinates.
struct Box {
  float left = 0, top = 0, right = 0, bottom = 0;

  float area() const { return is_empty() ? 0.0f : (right - left) * (bottom - top); }
  bool is_empty() const { return right <= left || bottom <= top; }
  bool operator==(const Box&) const = default;
};

Box common(const Box& a, const Box& b);
/// The smallest that holds both.
Box enclosing(const Box& a, const Box& b);

/// Triangles that are drawn together.
struct DrawnPart {
  Box box;
  std::uint64_t digest = 0;  ///< the same for the same triangles
  bool operator==(const DrawnPart&) const = default;
};

struct DrawnPane {
  const void* pane = nullptr;    ///< which one
  std::vector<DrawnPart> parts;  ///< in the order in which they lie over one another
  bool operator==(const DrawnPane&) const = default;
};

struct DrawnPicture {
  Box window;
  std::uint64_t ground = 0;  ///< its colour
  Box canvas;                ///< where something is painted under the panes; it is painted as a whole
  std::uint64_t canvas_digest = 0;
  std::vector<DrawnPane> panes;
  bool operator==(const DrawnPicture&) const = default;
};

/// Boxes that have nothing in common, of whole pixels: outside of them `now` looks like `before`.
std::vector<Box> changes_between(const DrawnPicture& before, const DrawnPicture& now);

}  // namespace inkwell::window
