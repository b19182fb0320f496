// The card for the connection state.
#pragma once

#include <optional>
#include <string>

#include "host/companion/window/bars/firmware_card.hpp"
#include "host/companion/window/device_desk/device_desk.hpp"
#include "host/companion/window/frame/style.hpp"

namespace inkwell::window {

const char* connection_title(const device::SessionStatus& status);
Colour connection_colour(device::Connection connection, const Palette& palette);

/// Offer of a virtual board while no device is connected.
struct VirtualBoardOffer {
  bool is_made;
  const std::string& problem;  ///< error of the last start of a virtual board; empty: no error
};
struct ConnectionCardOutcome {
  FirmwareCardOutcome firmware;
  bool starts_virtual_board = false;
  std::optional<std::string> chosen_serial_number{};
};
/// Draws a card in the middle of the scene. The card shows the update progress or the connection error.
ConnectionCardOutcome draw_connection_card(ImVec2 centre, const Style& style, const DeviceView& view,
                                           const FirmwareUpdater::Sight& firmware, const VirtualBoardOffer& offer);

}  // namespace inkwell::window
