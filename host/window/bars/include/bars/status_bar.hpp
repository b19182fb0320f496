// The bar on top: which device, how it is, force on and off, stop.
#pragma once

#include <cstdint>

#include <device_desk/device_desk.hpp>
#include <frame/style.hpp>

namespace inkwell::window {

struct StatusBarInput {
  bool scope_is_shown;
  bool is_replay;  ///< a recording stands in the arm's place, which gets no force meanwhile
};

struct StatusBarOutcome {
  bool switch_force_on = false;
  bool stop = false;
  bool clear_fault = false;
  bool toggle_theme = false;
  bool toggle_scope = false;
  bool help = false;
};

class StatusBar {
 public:
  /// The gauges wrap where the window is narrow or its text large.
  float height(float width, const Style& style) const;
  StatusBarOutcome draw(ImVec2 place, ImVec2 size, const Style& style, DeviceDesk& desk, const StatusBarInput& input);

 private:
  void draw_device(ImVec2 corner, const Style& style, DeviceDesk& desk);
  void draw_device_list(const Style& style, DeviceDesk& desk);
  void draw_buttons(ImVec2 corner, const Style& style, const DeviceView& view, const StatusBarInput& input,
                    StatusBarOutcome& outcome) const;
  /// The stylus' two buttons and the inkwell, as the board feels them.
  void draw_switches(ImVec2 corner, const Style& style, std::uint8_t switches) const;
};

}  // namespace inkwell::window
