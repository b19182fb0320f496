// The status bar with device, gauges, force button and stop button.
#pragma once

#include <cstdint>
#include <string>

#include "host/companion/window/device_desk/device_desk.hpp"
#include "host/companion/window/frame/style.hpp"

namespace inkwell::window {

struct StatusBarInput {
  bool scope_is_shown;
  std::string force_waits;      ///< reason why the force cannot be switched on; empty: it can
  std::string recording_waits;  ///< reason why no recording can start; empty: a recording can start
  std::string recording_clock;  ///< duration of the running recording; empty: no recording
};

struct StatusBarOutcome {
  bool switch_force_on = false;
  bool stop = false;
  bool clear_fault = false;
  bool toggle_theme = false;
  bool toggle_scope = false;
  bool help = false;
  bool toggle_recording = false;
  bool mark = false;
};

class StatusBar {
 public:
  /// Returns the height of the bar. The gauges wrap in a narrow window or with large text.
  float height(float width, const Style& style) const;
  StatusBarOutcome draw(ImVec2 origin, ImVec2 size, const Style& style, DeviceDesk& desk, const StatusBarInput& input);

 private:
  void draw_device(ImVec2 corner, const Style& style, DeviceDesk& desk);
  void draw_device_list(const Style& style, DeviceDesk& desk);
  void draw_buttons(ImVec2 corner, const Style& style, const DeviceView& view, const StatusBarInput& input,
                    StatusBarOutcome& outcome) const;
  /// Draws the button that starts a recording, or the buttons of a running recording.
  void draw_recording(ImVec2 corner, const Style& style, const StatusBarInput& input, StatusBarOutcome& outcome) const;
  /// Draws the state of the two stylus buttons and of the inkwell switch.
  void draw_switches(ImVec2 corner, const Style& style, std::uint8_t switches) const;
};

}  // namespace inkwell::window
