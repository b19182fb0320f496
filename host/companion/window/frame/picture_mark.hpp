// Detects whether the window's buffer still contains the last picture. After a buffer swap, OpenGL may provide a
// different buffer.
#pragma once

#include <cstdint>

namespace inkwell::window {

/// Stores a number in the invisible alpha value of the first pixel. To read the number, the CPU waits for the GPU, so
/// the window uses the mark only with software rendering.
class PictureMark {
 public:
  bool is_there() const;
  /// Writes a new number into the pixel.
  void put();

 private:
  std::uint8_t number_ = 0;
};

}  // namespace inkwell::window
