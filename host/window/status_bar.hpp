// The bar on top: which device, how it is, force on and off, stop; and under it the fault, if there is one.
#pragma once

#include "device_desk.hpp"
#include "style.hpp"

namespace inkwell::window {

struct StatusBarOutcome {
  bool switch_force_on = false;
  bool stop = false;
  bool clear_fault = false;
  bool toggle_theme = false;
  bool toggle_scope = false;
};

inline constexpr float status_bar_points = 54.0f;
inline constexpr float fault_banner_points = 62.0f;

class StatusBar {
 public:
  StatusBarOutcome draw(ImVec2 place, ImVec2 size, const Style& style, DeviceDesk& desk, bool scope_is_shown);

 private:
  void draw_device(const Style& style, DeviceDesk& desk);
  void draw_device_list(const Style& style, DeviceDesk& desk);
  /// As many as there is room for left of `limit_x`.
  void draw_gauges(float limit_x, const Style& style, const DeviceView& view) const;
  /// The stylus' two buttons and the inkwell, as the board feels them.
  void draw_switches(float left_x, float right_x, float y, const Style& style, std::uint8_t switches) const;
};

/// Draws the fault with its cause and remedy; true when "Clear fault" was pressed.
bool draw_fault_banner(ImVec2 place, ImVec2 size, const Style& style, protocol::Fault fault);

/// A card in the middle of the scene that says why no device is connected and what to do.
void draw_connection_card(ImVec2 centre, const Style& style, const DeviceView& view);

}  // namespace inkwell::window
