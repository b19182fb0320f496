// ImGui with its two back ends, for as long as the window is open, and its frames.
#pragma once

#include <vector>

#include <imgui.h>

#include <frame/key_taps.hpp>
#include <frame/picture_changes.hpp>

struct GLFWwindow;

namespace inkwell::window {

class ImGuiFrames {
 public:
  explicit ImGuiFrames(GLFWwindow* window);
  ~ImGuiFrames();
  ImGuiFrames(const ImGuiFrames&) = delete;
  ImGuiFrames& operator=(const ImGuiFrames&) = delete;

  /// Tells of every key that goes down, so that none is missed that comes up again before the next frame.
  void note_key_down(int key);

  void begin();
  ImVec2 size() const;  ///< of the window, in screen coordinates
  void end();
  /// What the frame that has ended consists of.
  std::vector<DrawnPane> panes() const;
  /// What of it lies in the box, into the framebuffer.
  void draw(const Box& box) const;

 private:
  KeyTaps taps_;
};

}  // namespace inkwell::window
