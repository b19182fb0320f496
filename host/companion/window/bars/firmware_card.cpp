#include "host/companion/window/bars/firmware_card.hpp"

#include <fmt/format.h>

#include "host/companion/window/frame/widgets.hpp"

namespace inkwell::window {
namespace {

using Phase = FirmwareUpdater::Phase;

void draw_progress(const Style& style, const FirmwareUpdater::Sight& sight) {
  const Palette& palette = *style.palette;
  const ImVec2 corner = ImGui::GetCursorScreenPos();
  const float width = ImGui::GetContentRegionAvail().x, height = style.points(8), round = style.points(4);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddRectFilled(corner, {corner.x + width, corner.y + height}, packed(palette.raised), round);
  list.AddRectFilled(corner, {corner.x + width * static_cast<float>(sight.done), corner.y + height},
                     packed(palette.accent), round);
  ImGui::Dummy({width, height + style.points(4)});
  text(palette.text_quiet, sight.message);
  wrapped_text(palette.text, "Do not unplug the board, and do not switch off its power.");
}

bool update_button(const char* label, const Style& style) {
  ImGui::Dummy({0, style.points(4)});
  return coloured_button(label, style.palette->accent, style.palette->pane, {style.points(240), style.points(34)});
}

}  // namespace

bool has_firmware_card(const FirmwareUpdater::Sight& sight, const DeviceView& view) {
  return sight.phase != Phase::idle || (!view.connected() && sight.sees_boot_loader);
}

FirmwareCardOutcome draw_firmware_part(const Style& style, const FirmwareUpdater::Sight& sight) {
  const Palette& palette = *style.palette;
  FirmwareCardOutcome outcome;
  switch (sight.phase) {
    case Phase::runs:
      text(style.fonts.strong, palette.text, "Updating the firmware");
      draw_progress(style, sight);
      break;
    case Phase::awaits_consent:
      text(style.fonts.strong, palette.caution, "The board has a newer firmware");
      wrapped_text(palette.text_quiet, sight.message);
      outcome.update = update_button("Write older firmware", style);
      ImGui::SameLine();
      outcome.dismiss = quiet_button("Leave it", style);
      break;
    case Phase::failed:
      text(style.fonts.strong, palette.caution, "The update failed");
      wrapped_text(palette.text_quiet, sight.message);
      outcome.update = update_button("Try again", style);
      ImGui::SameLine();
      outcome.dismiss = quiet_button("Leave it", style);
      break;
    case Phase::done:
      text(style.fonts.strong, palette.good, "The firmware was updated");
      wrapped_text(palette.text_quiet, sight.message);
      outcome.dismiss = update_button("Continue", style);
      break;
    case Phase::idle:
      text(style.fonts.strong, palette.caution, "A board is in its boot loader");
      wrapped_text(
          palette.text_quiet,
          sight.brings.empty()
              ? "No firmware runs on this board, and this companion contains no firmware. Build the firmware with "
                "`tools/build board`."
              : fmt::format(
                    "No firmware runs on this board. This companion contains {}.{}", sight.brings,
                    sight.board.empty() ? " If the board reports its name, it receives the matching firmware." : ""));
      if (!sight.brings.empty()) outcome.update = update_button("Write firmware", style);
  }
  return outcome;
}

bool draw_firmware_offer(const Style& style, const FirmwareUpdater::Sight& sight) {
  if (sight.brings.empty()) {
    if (!sight.board.empty())
      wrapped_text(style.palette->text_quiet,
                   fmt::format("This companion contains no firmware for the board {}.", sight.board));
    return false;
  }
  wrapped_text(style.palette->text_quiet,
               fmt::format("This companion contains {}. An update keeps the stored parameters.", sight.brings));
  return update_button("Update firmware", style);
}

}  // namespace inkwell::window
