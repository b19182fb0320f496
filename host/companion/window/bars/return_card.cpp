#include "host/companion/window/bars/return_card.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include <fmt/format.h>

#include "host/companion/window/device_desk/parameter_editor.hpp"
#include "host/companion/window/frame/keyboard.hpp"
#include "host/companion/window/frame/shown_unit.hpp"
#include "host/companion/window/frame/widgets.hpp"

namespace inkwell::window {

namespace {

constexpr float card_points = 340.0f;
constexpr float card_margin_points = 12.0f;
constexpr float padding_points = 14.0f;
constexpr float top_points = 48.0f;  // below the buttons of the scene
/// A half-visible last row indicates that the list can be scrolled.
constexpr float rows_maximum = 5.5f, rows_minimum = 1.5f;
constexpr float around_rows_points = 150.0f;

void draw_row(const ReturnedValues::Row& row, float width, const Style& style) {
  const Palette& palette = *style.palette;
  const protocol::ParameterInfo& info = protocol::info(row.parameter);
  const auto [unit, factor] = shown_unit(info.unit);
  const std::string values =
      fmt::format("{:.6g}, was {:.6g}{}{}", factor * row.now, factor * row.before, unit.empty() ? "" : " ", unit);
  text(palette.text_quiet, full_label_of(info));
  help_on_hover(info.name, info.help, style);
  ImGui::SameLine();
  right_text(palette.text, values, width - ImGui::GetCursorPosX());
}

void draw_rows(const ReturnedValues& values, float room, const Style& style) {
  const float row_height = ImGui::GetTextLineHeightWithSpacing();
  const float fitting = std::floor(room / row_height - 0.5f) + 0.5f;
  const auto count = static_cast<float>(values.rows().size());
  if (ImGui::BeginChild("values", {0, std::min(count, std::clamp(fitting, rows_minimum, rows_maximum)) * row_height},
                        false, ImGuiWindowFlags_NavFlattened)) {
    scroll_by_page_keys();
    const float width = ImGui::GetContentRegionAvail().x;
    for (const auto& row : values.rows()) draw_row(row, width, style);
  }
  ImGui::EndChild();
}

ReturnChoice draw_content(const ReturnedValues& values, float room, bool force_is_on, const Style& style) {
  const Palette& palette = *style.palette;
  const std::size_t count = values.rows().size();
  if (count == 0) {
    text(style.fonts.strong, palette.good, "Reconnected");
    wrapped_text(palette.text_quiet, "No value has changed since the last connection.");
    return ReturnChoice::none;
  }
  text(style.fonts.strong, palette.caution,
       count == 1 ? std::string("Reconnected: 1 value has changed")
                  : fmt::format("Reconnected: {} values have changed", count));
  wrapped_text(palette.text_quiet, "Values that are not stored are lost at power-off.");
  draw_rows(values, room, style);
  ImGui::Dummy({0, style.points(2)});
  const float gap = ImGui::GetStyle().ItemSpacing.x;
  const ImVec2 half{0.5f * (ImGui::GetContentRegionAvail().x - gap), 0};
  auto choice = ReturnChoice::none;
  const bool waits = force_is_on && std::ranges::any_of(values.rows(), [](const auto& row) {
                       return protocol::info(row.parameter).needs_force_off;
                     });
  ImGui::BeginDisabled(waits);
  if (primary_button(count == 1 ? "Restore old value" : "Restore old values", style, half)) choice = ReturnChoice::send;
  ImGui::EndDisabled();
  help_on_hover("",
                waits ? "Switch the force off first. While the force is on, the board refuses some of these values."
                      : "Sends all old values in one transaction. You can undo this change.",
                style);
  ImGui::SameLine();
  if (button("Keep new values", half)) choice = ReturnChoice::keep;
  return choice;
}

}  // namespace

ReturnChoice draw_return_card(ImVec2 origin, ImVec2 size, const Style& style, const ReturnedValues& values,
                              bool force_is_on) {
  const float margin = style.points(card_margin_points);
  ImGui::SetNextWindowPos({origin.x + size.x - margin, origin.y + style.points(top_points)}, ImGuiCond_Always,
                          {1.0f, 0.0f});
  ImGui::SetNextWindowSize({std::min(style.points(card_points), size.x - 2 * margin), 0});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, style.points(8));
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2{style.points(padding_points), style.points(padding_points)});
  ImGui::Begin("returned", nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
                   ImGuiWindowFlags_NoFocusOnAppearing);
  const ReturnChoice choice =
      draw_content(values, size.y - style.points(top_points + around_rows_points), force_is_on, style);
  ImGui::End();
  ImGui::PopStyleVar(2);
  return choice;
}

}  // namespace inkwell::window
