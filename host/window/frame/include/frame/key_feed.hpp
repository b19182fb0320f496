// The route of the keys from GLFW to ImGui's back end.
#pragma once

#include <frame/key_filter.hpp>
#include <frame/key_taps.hpp>

struct GLFWwindow;

namespace inkwell::window {

/// ImGui's GLFW back end with its keys: it receives only those that this class passes on.
class KeyFeed {
 public:
  /// Starts the back end. ImGui's context must exist, and the window must have its own callbacks.
  explicit KeyFeed(GLFWwindow* window);
  ~KeyFeed();
  KeyFeed(const KeyFeed&) = delete;
  KeyFeed& operator=(const KeyFeed&) = delete;

  /// Passes an event of the window on, except for the keys that stop the force.
  void take(const KeyEvent& event);
  /// Between the back end's NewFrame and ImGui's.
  void begin_frame();

 private:
  GLFWwindow* window_;
  KeyTaps taps_;
};

}  // namespace inkwell::window
