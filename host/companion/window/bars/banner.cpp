#include "host/companion/window/bars/banner.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "host/client/device/fault_text.hpp"
#include "host/companion/window/device_desk/motor_heat_view.hpp"
#include "host/companion/window/frame/widgets.hpp"

namespace inkwell::window {

using protocol::State;

namespace {

constexpr float banner_margin_points = 12.0f;
constexpr float button_points = 118.0f;
constexpr float button_height_points = 28.0f;
constexpr float text_left_points = 44.0f;
constexpr float banner_top_points = 10.0f;

float banner_text_width(float width, const Style& style, const Banner& banner) {
  return width -
         style.points(text_left_points + (banner.action != BannerAction::none ? button_points + 2 * banner_margin_points
                                                                              : banner_margin_points));
}

/// Returns an update banner if the firmware versions differ.
std::optional<Banner> firmware_banner(const DeviceView& view, const FirmwareUpdater::Sight& firmware) {
  const std::string& version = view.status.information->firmware_version;
  if (firmware.phase != FirmwareUpdater::Phase::idle || firmware.version.empty() || firmware.version == version ||
      protocol::force_is_on(view.state()))
    return std::nullopt;
  return Banner{
      fmt::format("The board runs firmware {}, and this companion contains firmware {}.", version, firmware.version),
      "Both firmware versions use the same protocol, so the update is optional. The update keeps the stored "
      "parameters.",
      BannerAction::update_firmware, "Update"};
}

}  // namespace

std::optional<Banner> banner_of(const DeviceView& view, bool is_replay, const FirmwareUpdater::Sight& firmware,
                                const std::string& object_problem) {
  if (view.pose && view.pose->state == State::fault) {
    const auto& test = view.status.self_test;
    const auto [cause, remedy] =
        test ? device::fault_text(view.pose->fault, *test) : device::fault_text(view.pose->fault);
    return Banner{cause, remedy, BannerAction::clear_fault, "Clear fault"};
  }
  if (!view.connected() || !view.status.information) return std::nullopt;
  if (is_replay && protocol::force_is_on(view.state()))
    return Banner{
        "The window shows a recording, but the force of the arm is on.",
        "Another program has switched the force on. STOP switches the force off. Close the replay to see the arm.",
        BannerAction::none};
  if (view.status.command_problem)
    return Banner{*view.status.command_problem,
                  "STOP switches the force off, even while another program drives the arm.", BannerAction::take_over,
                  "Take over"};
  if (!object_problem.empty())
    return Banner{"The object cannot be used.", object_problem + " Then start the program again.", BannerAction::none};
  const MotorHeatView heat = motor_heat_view(view.status.information->report);
  if (heat.level == HeatLevel::cool) return firmware_banner(view, firmware);
  return Banner{fmt::format("Motor {} is {}: motor heat {:.0f} %.", heat.motor,
                            heat.level == HeatLevel::hot ? "hot" : "warm", 100.0f * heat.hottest),
                heat_advice(heat), BannerAction::none};
}

float banner_height(float width, const Style& style, const Banner& banner) {
  const float room = banner_text_width(width, style, banner);
  const auto taken = [room](ImFont* font, const std::string& text) {
    return font->CalcTextSizeA(font->FontSize, 1e4f, room, text.c_str()).y;
  };
  const float text = taken(style.fonts.strong, banner.what) + taken(style.fonts.body, banner.remedy);
  const float buttons = banner.is_fault()                     ? 2 * button_height_points + 6
                        : banner.action == BannerAction::none ? 0
                                                              : button_height_points;
  return std::max(text + ImGui::GetStyle().ItemSpacing.y, style.points(buttons)) + style.points(2 * banner_top_points);
}

BannerAction draw_banner(ImVec2 origin, ImVec2 size, const Style& style, const Banner& banner) {
  const Palette& palette = *style.palette;
  const Colour colour = banner.is_fault() ? palette.danger_text : palette.caution;
  begin_top_pane("banner", origin, size, ImGuiWindowFlags_NoFocusOnAppearing);  // may cover the scene
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.PushClipRectFullScreen();
  const ImVec2 end{origin.x + size.x, origin.y + size.y};
  list.AddRectFilled(origin, end, packed(palette.pane), style.points(8));
  list.AddRectFilled(origin, {origin.x + style.points(6), end.y}, packed(colour), style.points(8),
                     ImDrawFlags_RoundCornersLeft);
  list.AddRect(origin, end, packed(colour), style.points(8), 0, style.points(1.5f));
  list.PopClipRect();
  warning_sign({origin.x + style.points(18), origin.y + style.points(10)}, colour, style);
  ImGui::SetCursorPos({style.points(text_left_points), style.points(banner_top_points)});
  ImGui::BeginGroup();
  ImGui::PushTextWrapPos(style.points(text_left_points) + banner_text_width(size.x, style, banner));
  text(style.fonts.strong, palette.text, banner.what);
  text(palette.text_quiet, banner.remedy);
  ImGui::PopTextWrapPos();
  ImGui::EndGroup();
  BannerAction pressed = BannerAction::none;
  const ImVec2 button_size{style.points(button_points), style.points(button_height_points)};
  const float left = size.x - style.points(button_points + banner_margin_points);
  if (banner.action != BannerAction::none) {
    ImGui::SetCursorPos({left, style.points(banner_top_points)});
    if (primary_button(banner.button.c_str(), style, button_size)) pressed = banner.action;
  }
  if (banner.is_fault()) {
    ImGui::SetCursorPos({left, style.points(banner_top_points + button_height_points + 6)});
    if (button("Show signals", button_size)) pressed = BannerAction::show_signals;
    help_on_hover("Show signals", "Shows the signals around the fault. The scope is frozen there.", style);
  }
  end_pane();
  return pressed;
}

}  // namespace inkwell::window
