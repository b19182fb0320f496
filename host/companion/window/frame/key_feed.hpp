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

  /// Passes a key event to ImGui if is_for_imgui() permits the event.
  void take(const KeyEvent& event);
  /// Calls ImGui::NewFrame() with the keys of this frame. Call after ImGui_ImplGlfw_NewFrame().
  void begin_frame();
  /// Returns true if ImGui has not yet applied all received events.
  bool has_waiting_events() const;

 private:
  GLFWwindow* window_;
  KeyTaps taps_;
};

}  // namespace inkwell::window
