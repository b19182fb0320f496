#include "host/companion/window/panes/store_bar.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "host/companion/window/device_desk/stored_values.hpp"
#include "host/companion/window/frame/imgui_versions.hpp"
#include "host/companion/window/frame/shown_unit.hpp"
#include "host/companion/window/frame/widgets.hpp"

namespace inkwell::window {

using protocol::Parameter;

namespace {

constexpr float mark_points = 14.0f;
constexpr float title_gap_points = 3.0f;
constexpr std::size_t listed_maximum = 12;
constexpr const char* restore_question = "restore stored values";
constexpr const char* reset_question = "factory reset";

/// Returns one line per value, such as "Wall stiffness: 1500 N/m, stored: 800".
std::string list_of(const std::vector<Parameter>& waiting, const DeviceView& view) {
  std::string lines;
  for (std::size_t i = 0; i < std::min(waiting.size(), listed_maximum); ++i) {
    const auto& row = protocol::info(waiting[i]);
    const auto [unit, factor] = shown_unit(row.unit);
    lines += fmt::format("{}{}: {:.6g}{}{}, stored: {:.6g}", i == 0 ? "" : "\n", full_label_of(row),
                         factor * (*view.parameters)[waiting[i]], unit.empty() ? "" : " ", unit,
                         factor * view.status.store->at_next_start[waiting[i]]);
  }
  if (waiting.size() > listed_maximum) lines += fmt::format("\nand {} more", waiting.size() - listed_maximum);
  return lines;
}

enum class Answer : std::uint8_t { none, yes, no };

struct Question {
  const char* name;
  std::string title;
  std::string explanation;
  const char* agree;  ///< text of the button that confirms
  bool is_grave;
};

/// Draws the confirmation dialog, if open. The dialog closes when the device is disconnected.
Answer draw_question(const Question& question, bool has_device, const Style& style) {
  const Palette& palette = *style.palette;
  ImGui::SetNextWindowPos(ImGui::GetMainViewport()->GetCenter(), ImGuiCond_Always, {0.5f, 0.5f});
  ImGui::SetNextWindowSize({style.points(440), 0});
  if (!ImGui::BeginPopupModal(question.name, nullptr, ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoMove))
    return Answer::none;
  text(style.fonts.strong, palette.text, question.title);
  wrapped_text(palette.text_quiet, question.explanation);
  ImGui::Dummy({0, style.points(4)});
  auto answer = Answer::none;
  if (question.is_grave ? grave_button(question.agree, style, {style.points(180), 0})
                        : primary_button(question.agree, style, {style.points(180), 0}))
    answer = Answer::yes;
  ImGui::SameLine();
  const bool cancels = button("Cancel", {style.points(100), 0});
  if (question.is_grave) ImGui::SetItemDefaultFocus();  // pressing Enter twice must not lose a calibration
  if (cancels || ImGui::IsKeyPressed(key_index(ImGuiKey_Escape))) answer = Answer::no;
  if (!has_device) answer = Answer::no;
  if (answer != Answer::none) ImGui::CloseCurrentPopup();
  ImGui::EndPopup();
  return answer;
}

}  // namespace

void not_stored_mark(ImVec2 centre, const Style& style) {
  ImGui::GetWindowDrawList()->AddCircle(centre, style.points(3.4f), packed(style.palette->caution), 0,
                                        style.points(1.6f));
}

void store_button(DeviceDesk& desk, ImVec2 size, const Style& style) {
  const DeviceView& view = desk.view();
  const bool is_needed = !not_stored(view).empty();
  const std::string waits = why_storing_waits(view);
  constexpr const char* label = "Store on board";
  const bool works = is_needed && waits.empty();
  ImGui::BeginDisabled(!works);
  if (works ? primary_button(label, style, size) : button(label, size)) desk.session().store_parameters();
  ImGui::EndDisabled();
  help_on_hover(label,
                works       ? "Stores all values permanently, including the calibration."
                : is_needed ? waits
                            : "All values will be the same after the next start of the board.",
                style);
}

std::string StoreBar::caption() const {
  const DeviceView& view = desk_.view();
  const device::SessionStatus& status = view.status;
  if (status.store_problem) return *status.store_problem;
  const std::size_t waiting = not_stored(view).size();
  if (waiting == 0)
    return status.store->report.contents == protocol::StoreContents::parameters ? "The values remain after power-off."
                                                                                : "Nothing is stored on the board.";
  if (protocol::force_is_on(view.state()))
    return fmt::format("The {} can be stored once the force is off.", waiting == 1 ? "value" : "values");
  const std::string waits = why_storing_waits(view);
  if (!waits.empty()) return waits;
  return fmt::format("The {} lost at power-off.", waiting == 1 ? "value is" : "values are");
}

float StoreBar::height(float width, const Style& style) const {
  if (stored_title(desk_.view()).empty()) return 0.0f;
  const ImFont& font = *style.fonts.caption;
  const float caption_height = font.CalcTextSizeA(font.FontSize, 1e4f, width, caption().c_str()).y;
  return ImGui::GetFrameHeight() + caption_height + style.fonts.strong->FontSize + 4 * ImGui::GetStyle().ItemSpacing.y +
         style.points(title_gap_points + 2);
}

void StoreBar::draw_title(const std::vector<Parameter>& waiting, const Style& style) const {
  const Palette& palette = *style.palette;
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing,
                      ImVec2{ImGui::GetStyle().ItemSpacing.x, style.points(title_gap_points)});
  if (!waiting.empty()) {
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    not_stored_mark({corner.x + style.points(5), corner.y + 0.5f * style.fonts.strong->FontSize}, style);
    ImGui::SetCursorPosX(ImGui::GetCursorPosX() + style.points(mark_points));
  }
  text(style.fonts.strong, waiting.empty() ? palette.text_quiet : palette.text, stored_title(desk_.view()));
  if (!waiting.empty()) help_on_hover("Not stored", list_of(waiting, desk_.view()), style);
  ImGui::PopStyleVar();
  ImGui::PushFont(style.fonts.caption);
  wrapped_text(desk_.view().status.store_problem ? palette.caution : palette.text_quiet, caption());
  ImGui::PopFont();
}

void StoreBar::draw_buttons(const std::vector<Parameter>& waiting, const Style& style) {
  const DeviceView& view = desk_.view();
  const bool has_stored = view.status.store->report.contents == protocol::StoreContents::parameters;
  const float gap = ImGui::GetStyle().ItemSpacing.x;
  const float width = ImGui::GetContentRegionAvail().x - 2 * gap;
  store_button(desk_, {0.46f * width, 0}, style);
  ImGui::SameLine();
  ImGui::BeginDisabled(!has_stored || waiting.empty());
  if (button("Restore", {0.22f * width, 0})) ImGui::OpenPopup(restore_question);
  ImGui::EndDisabled();
  help_on_hover("Restore",
                has_stored ? "Sets every parameter to its stored value, after a confirmation."
                           : "Nothing is stored on the board.",
                style);
  ImGui::SameLine();
  const std::string waits = why_storing_waits(view);
  ImGui::BeginDisabled(!waits.empty());
  if (button("Factory reset", {0.32f * width, 0})) ImGui::OpenPopup(reset_question);
  ImGui::EndDisabled();
  help_on_hover(
      "Factory reset",
      waits.empty() ? "Erases the stored values and sets every parameter to its default, after a confirmation." : waits,
      style);
}

void StoreBar::draw_restore_question(const std::vector<Parameter>& waiting, bool has_device, ParameterEditor& editor,
                                     const Style& style, double now_s) {
  const DeviceView& view = desk_.view();
  const Question question{restore_question, "Restore the stored values?",
                          waiting.empty() ? "The board already uses the stored values." : list_of(waiting, view),
                          "Restore", false};
  if (draw_question(question, has_device, style) != Answer::yes) return;
  std::vector<device::ParameterChange> changes;
  for (const Parameter parameter : waiting)
    changes.emplace_back(parameter, view.status.store->at_next_start[parameter]);
  editor.apply("stored values", changes, now_s);
}

void StoreBar::draw_reset_question(bool has_device, const Style& style) {
  const Question question{reset_question, "Erase all stored values?",
                          "Every parameter is set to its default, and the calibration of this arm is lost. To keep the "
                          "values in a file, press Cancel and then Save.",
                          "Erase and reset", true};
  if (draw_question(question, has_device, style) == Answer::yes) desk_.session().factory_reset();
}

void StoreBar::draw(ParameterEditor& editor, const Style& style, double now_s) {
  const DeviceView& view = desk_.view();
  const bool has_device = view.parameters && view.status.store;
  const std::vector<Parameter> waiting = not_stored(view);
  if (has_device) {
    ImGui::Dummy({0, style.points(1)});
    ImGui::Separator();
    draw_title(waiting, style);
    draw_buttons(waiting, style);
  }
  draw_restore_question(waiting, has_device, editor, style, now_s);
  draw_reset_question(has_device, style);
}

}  // namespace inkwell::window
