// The banner over the scene.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "host/companion/window/bars/firmware_updater.hpp"
#include "host/companion/window/device_desk/device_desk.hpp"
#include "host/companion/window/frame/style.hpp"

namespace inkwell::window {

enum class BannerAction : std::uint8_t { none, clear_fault, show_signals, update_firmware, take_over };

struct Banner {
  std::string what;
  std::string remedy;
  BannerAction action;  ///< action of the banner's button
  std::string button{};

  bool is_fault() const { return action == BannerAction::clear_fault; }
};
/// `object_problem`: sentences about an object that cannot be used, or empty.
std::optional<Banner> banner_of(const DeviceView& view, bool is_replay, const FirmwareUpdater::Sight& firmware,
                                const std::string& object_problem);
float banner_height(float width, const Style& style, const Banner& banner);
/// Returns the action of the pressed button.
BannerAction draw_banner(ImVec2 origin, ImVec2 size, const Style& style, const Banner& banner);

}  // namespace inkwell::window
