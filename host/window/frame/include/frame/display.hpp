// The window of the operating system and its OpenGL context.
#pragma once

#include <filesystem>
#include <functional>
#include <stdexcept>
#include <string>
#include <utility>

#include <imgui.h>

#include <frame/key_filter.hpp>
#include <frame/window_size.hpp>

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
  /// A `scale` of 0 is that of the main display: pixels for one point, 1 for 96 dots per inch.
  Display(ScreenSize points, float scale, const std::string& title);
  ~Display();
  Display(const Display&) = delete;
  Display& operator=(const Display&) = delete;

  GLFWwindow* handle() const { return window_; }
  float scale() const { return scale_; }  ///< pixels for one point
  double refresh_rate_Hz() const;
  bool draws_in_software() const;  ///< OpenGL has no graphics card
  ImVec2 corner() const;           ///< top left of what is drawn, on the screen; (0, 0) on Wayland, which hides it

  /// What is drawn, in pixels; 0 by 0 while it is shrunk to an icon.
  struct Size {
    int width, height;
  };
  Size framebuffer_size() const;

  bool is_to_be_closed() const;
  void close();
  void take_events();                      ///< what the user and the window system did
  void wait_for_events(double at_most_s);  ///< until there are some, and takes them
  /// Has `wait_for_events` return; from any thread.
  static void wake();
  /// What was drawn goes to the screen.
  void show();

  /// True if the user or the window system did something since the last call.
  bool take_input() { return std::exchange(had_input_, false); }
  /// True if the screen lost the picture, so that it has to be drawn again though it stays the same.
  bool take_lost_picture() { return std::exchange(lost_picture_, false); }

  /// `take` is called with every key event of the window.
  void on_key(std::function<void(const KeyEvent&)> take) { on_key_ = std::move(take); }

 private:
  GLFWwindow* window_ = nullptr;
  float scale_ = 1.0f;
  std::function<void(const KeyEvent&)> on_key_;
  bool had_input_ = true;
  bool lost_picture_ = true;
};

/// Writes the whole framebuffer as it stands. Throws DisplayError.
void write_screenshot(const std::filesystem::path& path, int width, int height);

}  // namespace inkwell::window
