// The window of the operating system and its OpenGL context.
#pragma once

#include <filesystem>
#include <functional>
#include <stdexcept>
#include <string>
#include <utility>

#include <imgui.h>

struct GLFWwindow;

namespace inkwell::window {

/// The window cannot be opened; `what()` says why and what to do.
class DisplayError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

class Display {
 public:
  /// Throws DisplayError if there is no display or no OpenGL 3.3.
  Display(int width, int height, const std::string& title);
  ~Display();
  Display(const Display&) = delete;
  Display& operator=(const Display&) = delete;

  GLFWwindow* handle() const { return window_; }
  float content_scale() const;  ///< pixels of text for one point, 1 on an ordinary display
  double refresh_rate_Hz() const;
  bool draws_in_software() const;  ///< OpenGL has no graphics card
  ImVec2 corner() const;           ///< top left of what is drawn, on the screen

  /// True if the user or the window system did something since the last call.
  bool take_input() { return std::exchange(had_input_, false); }
  /// True if the screen lost the picture, so that it has to be drawn again though it stays the same.
  bool take_lost_picture() { return std::exchange(lost_picture_, false); }

  /// `pressed(key)` is called for every key that goes down, before the panes see it.
  void on_key(std::function<void(int key, bool down)> pressed) { on_key_ = std::move(pressed); }

 private:
  GLFWwindow* window_ = nullptr;
  std::function<void(int, bool)> on_key_;
  bool had_input_ = true;
  bool lost_picture_ = true;
};

/// Writes the whole framebuffer as it stands. Throws DisplayError.
void write_screenshot(const std::filesystem::path& path, int width, int height);

/// Sleeps so that frames come at a steady rate where the display does not hold them back itself.
class FramePacer {
 public:
  /// `keeps_up`: what to suppose until frames tell.
  FramePacer(double frames_per_second, bool keeps_up) : period_s_(1.0 / frames_per_second), keeps_up_(keeps_up) {}
  void wait();
  /// No frame is wanted for a while: what passes until the next `wait` is no slowness.
  void rest() { half_second_began_s_ = 0.0; }

  /// True while the frames come as they should; false once half a second of them was a fifth too slow, for good.
  bool keeps_up() const { return keeps_up_; }

 private:
  double period_s_;
  double next_s_ = 0.0;
  double half_second_began_s_ = 0.0;
  int frames_in_it_ = 0;
  bool keeps_up_;
};

}  // namespace inkwell::window
