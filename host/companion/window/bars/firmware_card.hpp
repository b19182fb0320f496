// The firmware update on the connection card.
#pragma once

#include "host/companion/window/bars/firmware_updater.hpp"
#include "host/companion/window/device_desk/device_desk.hpp"
#include "host/companion/window/frame/style.hpp"

namespace inkwell::window {

struct FirmwareCardOutcome {
  bool update = false, dismiss = false;
};

/// Returns true during an update, after an update, or if a board is in boot loader mode.
bool has_firmware_card(const FirmwareUpdater::Sight& sight, const DeviceView& view);
/// Draws the state of the update on the card.
FirmwareCardOutcome draw_firmware_part(const Style& style, const FirmwareUpdater::Sight& sight);
/// Offers an update if the protocol versions differ. Returns true if the update button was pressed.
bool draw_firmware_offer(const Style& style, const FirmwareUpdater::Sight& sight);

}  // namespace inkwell::window
