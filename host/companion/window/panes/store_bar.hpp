// State of the stored values, and the buttons Store, Restore and Factory reset.
#pragma once

#include <string>
#include <vector>

#include "host/companion/window/device_desk/device_desk.hpp"
#include "host/companion/window/device_desk/parameter_editor.hpp"
#include "host/companion/window/frame/style.hpp"

namespace inkwell::window {

/// Draws the button that stores the values on the board. If the board refuses to store values, the tooltip shows the
/// reason.
void store_button(DeviceDesk& desk, ImVec2 size, const Style& style);

/// Draws a hollow dot as the mark of an unstored value.
void not_stored_mark(ImVec2 centre, const Style& style);

/// The bar at the bottom of a pane.
class StoreBar {
 public:
  explicit StoreBar(DeviceDesk& desk) : desk_(desk) {}

  float height(float width, const Style& style) const;
  void draw(ParameterEditor& editor, const Style& style, double now_s);

 private:
  /// Returns the text below the title: the last error, the reason for a refusal, or a description.
  std::string caption() const;
  void draw_title(const std::vector<protocol::Parameter>& waiting, const Style& style) const;
  void draw_buttons(const std::vector<protocol::Parameter>& waiting, const Style& style);
  void draw_restore_question(const std::vector<protocol::Parameter>& waiting, bool has_device, ParameterEditor& editor,
                             const Style& style, double now_s);
  void draw_reset_question(bool has_device, const Style& style);

  DeviceDesk& desk_;
};

}  // namespace inkwell::window
