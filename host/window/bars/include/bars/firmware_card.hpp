// What the card in the middle of the scene says of a firmware update.
#pragma once

#include <bars/firmware_updater.hpp>
#include <device_desk/device_desk.hpp>
#include <frame/style.hpp>

namespace inkwell::window {

struct FirmwareCardOutcome {
  bool update = false, dismiss = false;
};

/// There is an update to be told of, or a boot loader that waits for one.
bool has_firmware_card(const FirmwareUpdater::Sight& sight, const DeviceView& view);
/// The card's content then.
FirmwareCardOutcome draw_firmware_part(const Style& style, const FirmwareUpdater::Sight& sight);
/// Below the sentence that a device speaks another version. True when its button was pressed.
bool draw_firmware_offer(const Style& style, const FirmwareUpdater::Sight& sight);

}  // namespace inkwell::window
