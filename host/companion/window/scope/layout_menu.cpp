#include "host/companion/window/scope/layout_menu.hpp"

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include "host/companion/window/frame/imgui_versions.hpp"
#include "host/companion/window/frame/widgets.hpp"

namespace inkwell::window {

void LayoutMenu::draw(ScopeLayout& layout, const Style& style) {
  const bool is_changed = layout != layout_named(layout.name, own_);
  const std::string shown = layout.name + (is_changed ? ", changed" : "");
  if (begin_combo("##layout", shown, style.points(128), ImGuiComboFlags_HeightLargest)) {
    draw_choices(layout);
    ImGui::EndCombo();
  }
  help_on_hover(shown,
                "Selects a layout of the plots. The layout \"paper\" shows figures 11 to 14 of the paper. You can save "
                "custom layouts.",
                style);
  if (task_ != NameTask::none) draw_name(layout, style);
}

void LayoutMenu::draw_choices(ScopeLayout& layout) {
  const bool is_own = own_.find(layout.name) != nullptr;
  const bool is_changed = layout != layout_named(layout.name, own_);
  const ScopeLayout* chosen = nullptr;
  const auto offer = [&](const ScopeLayout& offered) {
    need_glyphs(offered.name);
    if (ImGui::Selectable(offered.name.c_str(), offered.name == layout.name)) chosen = &offered;
  };
  for (const ScopeLayout& each : built_in_layouts()) offer(each);
  if (!own_.all().empty()) ImGui::Separator();
  for (const ScopeLayout& each : own_.all()) offer(each);
  ImGui::Separator();
  if (ImGui::Selectable("Add a plot")) layout.plots.push_back({PlotKind::time, "Plot", {protocol::Signal::force_N}});
  if (is_own && is_changed && ImGui::Selectable("Save the changes")) own_.save(layout);
  if (ImGui::Selectable("Save as...")) open_name_dialog(NameTask::save, is_own ? layout.name : std::string());
  if (is_own && ImGui::Selectable("Rename...")) open_name_dialog(NameTask::rename, layout.name);
  if (chosen != nullptr) layout = ScopeLayout{*chosen};
  if (is_own && ImGui::Selectable("Delete")) {
    own_.remove(layout.name);
    layout = built_in_layouts().front();
  }
}

void LayoutMenu::open_name_dialog(NameTask task, const std::string& suggestion) {
  task_ = task;
  name_ = suggestion;
}

void LayoutMenu::draw_name(ScopeLayout& layout, const Style& style) {
  constexpr char title[] = "layout name";
  const bool renames = task_ == NameTask::rename;
  if (!ImGui::IsPopupOpen(title)) {
    ImGui::OpenPopup(title);
    refusal_.clear();
  }
  ImGui::SetNextWindowSize({style.points(340), 0});
  ImGui::SetNextWindowPos(ImGui::GetMainViewport()->GetCenter(), ImGuiCond_Always, {0.5f, 0.5f});
  if (!ImGui::BeginPopupModal(title, nullptr, ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoMove)) return;
  text(style.fonts.strong, style.palette->text,
       renames ? fmt::format("Rename \"{}\"", layout.name) : std::string("Save this layout"));
  if (ImGui::IsWindowAppearing()) ImGui::SetKeyboardFocusHere();
  ImGui::SetNextItemWidth(-1);
  need_glyphs(name_);
  const bool entered = ImGui::InputTextWithHint("##name", "layout name", &name_, ImGuiInputTextFlags_EnterReturnsTrue);
  if (!refusal_.empty()) wrapped_text(style.palette->caution, refusal_);
  const bool confirmed = primary_button(renames ? "Rename" : "Save", style, {style.points(100), 0});
  ImGui::SameLine();
  const bool cancelled = button("Cancel", {style.points(100), 0}) || ImGui::IsKeyPressed(key_index(ImGuiKey_Escape));
  if (cancelled || ((confirmed || entered) && save_name(layout))) {
    task_ = NameTask::none;
    ImGui::CloseCurrentPopup();
  }
  ImGui::EndPopup();
}

bool LayoutMenu::save_name(ScopeLayout& layout) {
  const bool renames = task_ == NameTask::rename;
  refusal_ = renames ? own_.rename(layout.name, name_) : OwnLayouts::refusal(name_);
  if (!refusal_.empty()) return false;
  layout.name = name_;
  if (!renames) own_.save(layout);
  return true;
}

}  // namespace inkwell::window
