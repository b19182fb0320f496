// Passes keys from GLFW to ImGui's back end.
#pragma once

#include "host/companion/window/frame/key_filter.hpp"
#include "host/companion/window/frame/key_taps.hpp"

struct GLFWwindow;

namespace inkwell::window {

/// ImGui's GLFW back end with filtered key events.
class KeyFeed {
 public:
  /// Starts the back end. The ImGui context must exist, and the window's callbacks must be set.
  explicit KeyFeed(GLFWwindow* window);
  ~KeyFeed();
  KeyFeed(const KeyFeed&) = delete;
  KeyFeed& operator=(const KeyFeed&) = delete;

  /// Passes an event of the window to ImGui, except for the keys that stop the force.
  void take(const KeyEvent& event);
  /// Calls ImGui::NewFrame() with the keys of this frame. Call after the NewFrame() of the back end.
  void begin_frame();
  /// True if a later frame will apply events that have arrived.
  bool has_waiting_events() const;

 private:
  GLFWwindow* window_;
  KeyTaps taps_;
};

}  // namespace inkwell::window
