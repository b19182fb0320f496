#include "host/companion/window/bars/connection_card.hpp"

#include <string>

#include "host/companion/window/frame/widgets.hpp"

namespace inkwell::window {

using device::Connection;

const char* connection_title(const device::SessionStatus& status) {
  switch (status.connection) {
    case Connection::searching: return "Searching for a device";
    case Connection::connected: return status.is_simulation ? "Simulated arm" : "Connected";
    case Connection::incompatible: return "Protocol mismatch";
    case Connection::no_permission: return "No permission";
  }
  return "";
}

Colour connection_colour(Connection connection, const Palette& palette) {
  if (connection == Connection::connected) return palette.good;
  return connection == Connection::searching ? palette.text_quiet : palette.caution;
}

namespace {

bool draw_virtual_board_offer(const Style& style, const VirtualBoardOffer& offer) {
  const Palette& palette = *style.palette;
  ImGui::Dummy({0, style.points(4)});
  const bool asks = primary_button("Start virtual board", style, {-1, style.points(32)});
  wrapped_text(
      offer.problem.empty() ? palette.text_quiet : palette.danger_text,
      offer.problem.empty()
          ? "The virtual board runs the same firmware with a simulated arm. The mouse moves the simulated hand."
          : offer.problem);
  return asks;
}

/// Returns the serial number of the chosen device.
std::optional<std::string> draw_choice(const Style& style, const DeviceView& view) {
  std::optional<std::string> chosen;
  for (const device::Endpoint& endpoint : view.listed) {
    ImGui::Dummy({0, style.points(2)});
    if (button(endpoint.serial_number.c_str(), {-1, style.points(32)})) chosen = endpoint.serial_number;
  }
  return chosen;
}

}  // namespace

ConnectionCardOutcome draw_connection_card(ImVec2 centre, const Style& style, const DeviceView& view,
                                           const FirmwareUpdater::Sight& firmware, const VirtualBoardOffer& offer) {
  const Palette& palette = *style.palette;
  ConnectionCardOutcome outcome;
  ImGui::SetNextWindowPos(centre, ImGuiCond_Always, {0.5f, 0.5f});
  ImGui::SetNextWindowSize({style.points(420), 0});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, style.points(8));
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2{style.points(20), style.points(16)});
  ImGui::Begin("connection", nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
                   ImGuiWindowFlags_NoFocusOnAppearing);
  if (has_firmware_card(firmware, view)) {
    outcome.firmware = draw_firmware_part(style, firmware);
  } else {
    text(style.fonts.strong, connection_colour(view.status.connection, palette), connection_title(view.status));
    // An error of the device search has priority over the session's message.
    const std::string& message = view.list_error.empty() ? view.status.message : view.list_error;
    wrapped_text(palette.text_quiet, message.empty()
                                         ? "Plug in the USB cable of the arm. The window then connects automatically."
                                         : message);
    if (view.status.connection == Connection::incompatible)
      outcome.firmware.update = draw_firmware_offer(style, firmware);
    if (view.must_choose) outcome.chosen_serial_number = draw_choice(style, view);
    if (offer.is_made) outcome.starts_virtual_board = draw_virtual_board_offer(style, offer);
  }
  ImGui::End();
  ImGui::PopStyleVar(2);
  return outcome;
}

}  // namespace inkwell::window
