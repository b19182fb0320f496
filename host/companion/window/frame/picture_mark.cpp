#include "host/companion/window/frame/picture_mark.hpp"

#include <array>

#include <epoxy/gl.h>

namespace inkwell::window {

namespace {

constexpr std::uint8_t opaque = 255;  // the value that a buffer without alpha returns

}  // namespace

bool PictureMark::is_there() const {
  std::array<std::uint8_t, 4> pixel{};
  glReadPixels(0, 0, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE, pixel.data());
  return number_ != 0 && pixel[3] == number_;
}

void PictureMark::put() {
  number_ = static_cast<std::uint8_t>(number_ + 1 < opaque ? number_ + 1 : 1);
  glEnable(GL_SCISSOR_TEST);
  glScissor(0, 0, 1, 1);
  glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_TRUE);
  glClearColor(0.0f, 0.0f, 0.0f, static_cast<float>(number_) / opaque);
  glClear(GL_COLOR_BUFFER_BIT);
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  glDisable(GL_SCISSOR_TEST);
}

}  // namespace inkwell::window
