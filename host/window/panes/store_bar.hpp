// What of the device's values outlives its power, and the buttons that store, restore and forget them.
#pragma once

#include <string>
#include <vector>

#include <device_desk/device_desk.hpp>
#include <device_desk/parameter_editor.hpp>
#include <frame/style.hpp>

namespace inkwell::window {

/// Has the board store its values when it is pressed; where that cannot be now, its help says why.
void store_button(DeviceDesk& desk, ImVec2 size, const Style& style);

/// A hollow dot, which stands for a value that is not stored.
void not_stored_mark(ImVec2 centre, const Style& style);

/// At the foot of a pane.
class StoreBar {
 public:
  explicit StoreBar(DeviceDesk& desk) : desk_(desk) {}

  float height(float width, const Style& style) const;
  void draw(ParameterEditor& editor, const Style& style, double now_s);

 private:
  /// The line below the title: what went wrong, what keeps the user from storing, or what it is about.
  std::string caption() const;
  void draw_title(const std::vector<protocol::Parameter>& waiting, const Style& style) const;
  void draw_buttons(const std::vector<protocol::Parameter>& waiting, const Style& style);
  void draw_restore_question(const std::vector<protocol::Parameter>& waiting, bool has_device, ParameterEditor& editor,
                             const Style& style, double now_s);
  void draw_reset_question(bool has_device, const Style& style);

  DeviceDesk& desk_;
};

}  // namespace inkwell::window
