// Finds the differences between two pictures. The window draws only the differences, because drawing is slow without a
// graphics card.
#pragma once

#include <cstdint>
#include <vector>

namespace inkwell::window {

/// A rectangle in screen coordinates.
struct Box {
  float left = 0, top = 0, right = 0, bottom = 0;

  float area() const { return is_empty() ? 0.0f : (right - left) * (bottom - top); }
  bool is_empty() const { return right <= left || bottom <= top; }
  bool operator==(const Box&) const = default;
};

Box common(const Box& a, const Box& b);
/// Returns the smallest box that contains `a` and `b`.
Box enclosing(const Box& a, const Box& b);

/// Triangles of one draw call.
struct DrawnPart {
  Box box;
  std::uint64_t digest = 0;  ///< equal for equal triangles
  bool operator==(const DrawnPart&) const = default;
};

struct DrawnPane {
  const void* pane = nullptr;    ///< identifies the pane
  std::vector<DrawnPart> parts;  ///< in drawing order
  bool operator==(const DrawnPane&) const = default;
};

struct DrawnPicture {
  Box window;
  int width_pixels = 0;  ///< of the framebuffer; the window system can resize the window during a frame
  int height_pixels = 0;
  std::uint64_t ground = 0;  ///< background color
  Box canvas;                ///< area of the scene, which is always painted completely
  std::uint64_t canvas_digest = 0;
  std::vector<DrawnPane> panes;
  bool operator==(const DrawnPicture&) const = default;
};

/// Returns disjoint boxes of whole pixels that contain all differences.
std::vector<Box> changes_between(const DrawnPicture& before, const DrawnPicture& now);

}  // namespace inkwell::window
