// Detects whether the window's buffer still contains the last picture. After a buffer swap OpenGL guarantees nothing:
// it may be another buffer or a new one.
#pragma once

#include <cstdint>

namespace inkwell::window {

/// Writes a number into an invisible location: the alpha value of the buffer's first pixel. This tests the actual
/// buffer instead of relying on the driver. Reading waits for all drawing, so it is used only for software rendering,
/// where a buffer is either complete or lost.
class PictureMark {
 public:
  bool is_there() const;
  /// Writes a number that differs from the previous ones.
  void put();

 private:
  std::uint8_t number_ = 0;
};

}  // namespace inkwell::window
