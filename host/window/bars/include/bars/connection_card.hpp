// How the window says whether it is connected.
#pragma once

#include <optional>
#include <string>

#include <bars/firmware_card.hpp>
#include <device_desk/device_desk.hpp>
#include <frame/style.hpp>

namespace inkwell::window {

const char* connection_title(const device::SessionStatus& status);
Colour connection_colour(device::Connection connection, const Palette& palette);

/// A virtual board in place of the device that is not there.
struct VirtualBoardOffer {
  bool is_made;
  const std::string& problem;  ///< why it could not be started the last time; empty: nothing is known
};
struct ConnectionCardOutcome {
  FirmwareCardOutcome firmware;
  bool starts_virtual_board = false;
  std::optional<std::string> chosen_serial_number{};
};
/// A card in the middle of the scene that says why no device is connected and what to do, or how an update goes.
ConnectionCardOutcome draw_connection_card(ImVec2 centre, const Style& style, const DeviceView& view,
                                           const FirmwareUpdater::Sight& firmware, const VirtualBoardOffer& offer);

}  // namespace inkwell::window
