// An operating system window with an OpenGL context.
#pragma once

#include <filesystem>
#include <functional>
#include <stdexcept>
#include <string>
#include <utility>

#include <imgui.h>

#include "host/companion/window/frame/key_filter.hpp"
#include "host/companion/window/frame/pixels.hpp"
#include "host/companion/window/frame/window_size.hpp"

struct GLFWwindow;

namespace inkwell::window {

/// Error of the display. `what()` returns the reason and the remedy.
class DisplayError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

class Display {
 public:
  /// Throws DisplayError if there is no display or no OpenGL 3.3. `scale` is the number of pixels per point (1/96
  /// inch), or 0 for the scale of the main display.
  Display(ScreenSize points, float scale, const std::string& title);
  ~Display();
  Display(const Display&) = delete;
  Display& operator=(const Display&) = delete;

  GLFWwindow* handle() const { return window_; }
  float scale() const { return scale_; }  ///< screen units per point
  double refresh_rate_Hz() const;
  bool draws_in_software() const;  ///< OpenGL runs without a graphics card
  ImVec2 corner() const;           ///< top left corner of the drawing area on the screen; (0, 0) on Wayland

  /// Size of the drawing area in pixels; 0 x 0 while the window is minimized.
  struct Size {
    int width, height;
  };
  Size framebuffer_size() const;

  bool is_to_be_closed() const;
  void close();
  void take_events();                      ///< processes the events of the user and the window system
  void wait_for_events(double at_most_s);  ///< waits for events and processes them
  /// Makes `wait_for_events` return. Any thread may call this function.
  static void wake();
  /// Shows the drawn picture on the screen.
  void show();

  /// Returns true if an event has occurred since the last call.
  bool take_input() { return std::exchange(had_input_, false); }
  /// Returns true if the window must be drawn again.
  bool take_lost_picture() { return std::exchange(lost_picture_, false); }

  /// Sets the function that receives all key events.
  void on_key(std::function<void(const KeyEvent&)> take) { on_key_ = std::move(take); }

 private:
  GLFWwindow* window_ = nullptr;
  float scale_ = 1.0f;
  std::function<void(const KeyEvent&)> on_key_;
  bool had_input_ = true;
  bool lost_picture_ = true;
};

/// Reads a rectangle of the framebuffer, in pixels from the lower left corner.
Pixels read_pixels(int left, int bottom, int width, int height);

/// Writes the whole framebuffer to a file. Throws DisplayError.
void write_screenshot(const std::filesystem::path& path, int width, int height);

}  // namespace inkwell::window
