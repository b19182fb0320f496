#include "host/companion/window/scope/signal_list.hpp"

#include <algorithm>
#include <limits>
#include <vector>

#include <fmt/format.h>
#include <imgui_stdlib.h>

#include "host/client/device/parameter_file.hpp"
#include "host/companion/window/frame/imgui_versions.hpp"
#include "host/companion/window/frame/inspection.hpp"
#include "host/companion/window/frame/keyboard.hpp"
#include "host/companion/window/frame/widgets.hpp"

namespace inkwell::window {

namespace {

constexpr float list_points = 206.0f;
constexpr char payload_type[] = "scope signal";

/// Draws a row that the user can drag into a plot.
void draw_row(const ScopeSignal& signal, ScopeLayout& layout, float width, const Style& style) {
  const std::string name(signal.name());
  const std::string label = fmt::format("{}##{}", fitted(name, width), name);
  ImGui::Selectable(label.c_str(), false, ImGuiSelectableFlags_AllowDoubleClick, {width, style.points(18)});
  const bool is_double_clicked = ImGui::IsItemHovered() && ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left);
  note_item(name);
  if (is_double_clicked || is_pressed_by_keyboard()) layout.plots.push_back({PlotKind::time, name, {signal}});
  if (ImGui::BeginDragDropSource(ImGuiDragDropFlags_SourceNoHoldToOpenOthers)) {
    ImGui::SetDragDropPayload(payload_type, name.data(), name.size());
    text(style.palette->text, name);
    ImGui::EndDragDropSource();
  }
  help_on_hover(
      name,
      fmt::format("{}\nDrag the signal into a plot. Double-click or press Enter for a separate plot.", signal.help()),
      style);
}

}  // namespace

void draw_search(std::string& search, const Style& style) {
  ImGui::SetNextItemWidth(-1);
  ImGui::InputTextWithHint("##search", "search", &search);
  note_item("search");
  help_on_hover("Search", "Searches the names, groups and help texts of the signals.", style);
}

std::optional<std::string> dropped_signal() {
  std::optional<std::string> dropped;
  if (!ImGui::BeginDragDropTarget()) return dropped;
  if (const ImGuiPayload* payload = ImGui::AcceptDragDropPayload(payload_type))
    dropped.emplace(static_cast<const char*>(payload->Data), static_cast<std::size_t>(payload->DataSize));
  ImGui::EndDragDropTarget();
  return dropped;
}

void SignalList::draw(ScopeLayout& layout, const Style& style) {
  if (is_shown_) {
    const float width = std::min(style.points(list_points), 0.4f * ImGui::GetContentRegionAvail().x);
    if (ImGui::BeginChild("signals", {width, 0}, false, ImGuiWindowFlags_NavFlattened)) {
      draw_search(search_, style);
      ImGui::PushFont(style.fonts.caption);
      draw_signals(layout, style);
      draw_formulas(layout, style);
      ImGui::PopFont();
    }
    ImGui::EndChild();
    ImGui::SameLine(0, style.points(10));
  }
  if (asked_about_) draw_dialog(layout, style);
}

void SignalList::draw_signals(ScopeLayout& layout, const Style& style) {
  const std::vector<SignalGroup> groups = signal_groups(search_);
  for (const SignalGroup& group : groups) {
    // During a search, the groups are initially open.
    const std::string title = fmt::format("{}###{}{}", group.title, group.title, search_.empty() ? "" : " found");
    ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, ImVec2{style.points(2), style.points(6)});
    ImGui::PushStyleVar(ImGuiStyleVar_FrameBorderSize, 0.0f);
    const bool is_open = ImGui::CollapsingHeader(title.c_str(), search_.empty() ? 0 : ImGuiTreeNodeFlags_DefaultOpen);
    note_item(group.title);
    ImGui::PopStyleVar(2);
    if (!is_open) continue;
    ImGui::Indent(style.points(17));
    for (const protocol::Signal signal : group.signals)
      draw_row(signal, layout, ImGui::GetContentRegionAvail().x, style);
    ImGui::Unindent(style.points(17));
  }
  if (groups.empty()) wrapped_text(style.palette->text_quiet, nothing_found);
}

void SignalList::draw_formulas(ScopeLayout& layout, const Style& style) {
  ImGui::Dummy({0, style.points(2)});
  std::optional<Formula> clicked;
  for (const Formula& formula : std::vector<Formula>(layout.formulas)) {
    const float edit_width = style.points(34);
    draw_row(ScopeSignal(formula), layout,
             ImGui::GetContentRegionAvail().x - edit_width - ImGui::GetStyle().ItemSpacing.x, style);
    const std::string edit = fmt::format("Edit##{}", formula.name);
    ImGui::SameLine(ImGui::GetContentRegionMax().x - edit_width);
    if (quiet_button(edit.c_str(), style)) clicked = formula;
  }
  if (button("New formula", {-1, 0})) clicked = Formula{};
  help_on_hover("New formula",
                "Computes a signal from other signals, such as force_x_N - program_force_x_N, with an optional filter.",
                style);
  if (clicked) ask_about(*clicked);
}

void SignalList::ask_about(const Formula& formula) {
  asked_about_ = formula;
  typed_ = formula;
  typed_low_pass_ = formula.low_pass_Hz > 0.0 ? fmt::format("{}", formula.low_pass_Hz) : std::string();
}

Formula SignalList::typed() const {
  Formula formula = typed_;
  if (formula.unit.empty()) formula.unit = find_unit(formula.text);
  if (!typed_low_pass_.empty()) {
    const auto number = device::parse_number(typed_low_pass_);
    formula.low_pass_Hz = number ? static_cast<double>(*number) : std::numeric_limits<double>::quiet_NaN();
  } else {
    formula.low_pass_Hz = 0.0;
  }
  return formula;
}

void SignalList::draw_fields(const Style& style) {
  const auto field = [&](const char* label, const char* id, const char* hint, std::string& value) {
    text(style.fonts.caption, style.palette->text_quiet, label);
    ImGui::SetNextItemWidth(-1);
    ImGui::InputTextWithHint(id, hint, &value);
    note_item(id + 2);
  };
  if (ImGui::IsWindowAppearing()) ImGui::SetKeyboardFocusHere();
  field("Formula of signal names and + - * / ^ ( ) sqrt abs sin cos min max", "##formula",
        "force_x_N - program_force_x_N", typed_.text);
  field("Signal name", "##name of formula", "force_error_N", typed_.name);
  const std::string known_unit = find_unit(typed_.text);
  field("Unit", "##unit", known_unit.empty() ? "such as Nm; 1 for no unit" : known_unit.c_str(), typed_.unit);
  field("Low-pass filter / Hz", "##filter", "none", typed_low_pass_);
}

void SignalList::draw_dialog(ScopeLayout& layout, const Style& style) {
  constexpr char title[] = "formula";
  if (!ImGui::IsPopupOpen(title)) ImGui::OpenPopup(title);
  ImGui::SetNextWindowSize({std::min(style.points(460), ImGui::GetMainViewport()->Size.x), 0});
  ImGui::SetNextWindowPos(ImGui::GetMainViewport()->GetCenter(), ImGuiCond_Always, {0.5f, 0.5f});
  if (!ImGui::BeginPopupModal(title, nullptr, ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoMove)) return;
  const bool is_new = asked_about_->name.empty();
  text(style.fonts.strong, style.palette->text, is_new ? "New formula" : asked_about_->name);
  draw_fields(style);
  const Formula formula = typed();
  std::string refusal = refusal_of(formula);
  if (refusal.empty() && formula.name != asked_about_->name &&
      std::ranges::find(layout.formulas, formula.name, &Formula::name) != layout.formulas.end())
    refusal = fmt::format("A formula named {} already exists. Choose another name.", formula.name);
  wrapped_text(
      refusal.empty() ? style.palette->text_quiet : style.palette->caution,
      refusal.empty() ? fmt::format("Unit of the plot: {}.", formula.unit == "1" ? "none" : formula.unit) : refusal);
  const ImVec2 size{style.points(100), 0};
  ImGui::BeginDisabled(!refusal.empty());
  bool is_over = primary_button("Draw signal", style, size);
  ImGui::EndDisabled();
  if (is_over) {
    put_formula(layout, formula, asked_about_->name);
    if (is_new) layout.plots.push_back({PlotKind::time, formula.name, {ScopeSignal(formula)}});
  }
  ImGui::SameLine();
  is_over |= button("Cancel", size) || ImGui::IsKeyPressed(key_index(ImGuiKey_Escape));
  if (!is_new) {
    ImGui::SameLine();
    if (button("Delete", size)) {
      remove_formula(layout, asked_about_->name);
      is_over = true;
    }
  }
  if (is_over) {
    asked_about_.reset();
    ImGui::CloseCurrentPopup();
  }
  ImGui::EndPopup();
}

}  // namespace inkwell::window
