// The banner under the status bar, while there is something to say.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include <bars/firmware_updater.hpp>
#include <device_desk/device_desk.hpp>
#include <frame/style.hpp>

namespace inkwell::window {

/// What has to be said over the whole width: a fault with its cause and remedy, an arm with force that is out of sight
/// behind a replay, another program that drives the arm, a motor that is hot, or another firmware than this
/// companion's.
enum class BannerAction : std::uint8_t { none, clear_fault, update_firmware, take_over };

struct Banner {
  std::string what;
  std::string remedy;
  BannerAction action;  ///< of its button
  std::string button{};

  bool is_fault() const { return action == BannerAction::clear_fault; }
};
std::optional<Banner> banner_of(const DeviceView& view, bool is_replay, const FirmwareUpdater::Sight& firmware);
float banner_height(float width, const Style& style, const Banner& banner);
/// True when its button was pressed.
bool draw_banner(ImVec2 place, ImVec2 size, const Style& style, const Banner& banner);

}  // namespace inkwell::window
