// ImGui with its two back ends.
#pragma once

#include <vector>

#include <imgui.h>

#include "host/companion/window/frame/key_feed.hpp"
#include "host/companion/window/frame/picture_changes.hpp"

struct GLFWwindow;

namespace inkwell::window {

/// Draws all later frames with this atlas, and deletes the previous atlas. Call between two frames.
void replace_font_atlas(ImFontAtlas* atlas);

class ImGuiFrames {
 public:
  explicit ImGuiFrames(GLFWwindow* window);
  ~ImGuiFrames();
  ImGuiFrames(const ImGuiFrames&) = delete;
  ImGuiFrames& operator=(const ImGuiFrames&) = delete;

  /// Passes a key event to ImGui if is_for_imgui() permits the event.
  void take_key(const KeyEvent& event) { keys_.take(event); }

  void begin();
  /// Returns true if ImGui has not yet applied all received events.
  bool has_waiting_events() const { return keys_.has_waiting_events(); }
  ImVec2 size() const;  ///< of the window, in screen coordinates
  void end();
  /// Returns the panes of the finished frame.
  std::vector<DrawnPane> panes() const;
  /// Draws the frame into the framebuffer, clipped to the box.
  void draw(const Box& box) const;

 private:
  struct Context {
    Context();
    ~Context();
  };
  Context context_;
  KeyFeed keys_;
};

}  // namespace inkwell::window
