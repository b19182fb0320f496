// Whether the window's buffer still holds what was drawn into it last. Once a picture is shown, OpenGL says nothing of
// the buffer: it may be another one, or a fresh one.
#pragma once

#include <cstdint>

namespace inkwell::window {

/// A number in a place where nobody sees it: the alpha of the buffer's first pixel. It is the buffer that is looked at
/// and not what the driver promises. Looking waits until all is drawn, so it is for drawing in software only, where a
/// buffer is a piece of memory that is there as a whole or not at all.
class PictureMark {
 public:
  bool is_there() const;
  /// Another one than the times before.
  void put();

 private:
  std::uint8_t number_ = 0;
};

}  // namespace inkwell::window
