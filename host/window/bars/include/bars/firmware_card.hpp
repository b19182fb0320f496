// Firmware update part of the card in the middle of the scene.
#pragma once

#include <bars/firmware_updater.hpp>
#include <device_desk/device_desk.hpp>
#include <frame/style.hpp>

namespace inkwell::window {

struct FirmwareCardOutcome {
  bool update = false, dismiss = false;
};

/// True while an update has something to show, or while a boot loader waits for an update.
bool has_firmware_card(const FirmwareUpdater::Sight& sight, const DeviceView& view);
/// Draws the content of the card in this case.
FirmwareCardOutcome draw_firmware_part(const Style& style, const FirmwareUpdater::Sight& sight);
/// Draws the update offer below the message about a different protocol version. Returns true if its button was pressed.
bool draw_firmware_offer(const Style& style, const FirmwareUpdater::Sight& sight);

}  // namespace inkwell::window
