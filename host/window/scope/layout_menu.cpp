// The scope's layouts: choosing one, and saving, renaming and deleting the user's own.
#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include <scope/scope_pane.hpp>

namespace inkwell::window {

void ScopePane::draw_layout_menu(const Style& style) {
  const ScopeLayout* own = own_layouts_.find(layout_.name);
  const bool is_changed = layout_ != layout_named(layout_.name, own_layouts_);
  ImGui::SetNextItemWidth(style.points(128));
  if (ImGui::BeginCombo("##layout", (layout_.name + (is_changed ? ", changed" : "")).c_str(),
                        ImGuiComboFlags_HeightLargest)) {
    const auto offer = [this](const ScopeLayout& layout) {
      if (ImGui::Selectable(layout.name.c_str(), layout.name == layout_.name)) choose_layout(ScopeLayout{layout});
    };
    for (const ScopeLayout& layout : built_in_layouts()) offer(layout);
    if (!own_layouts_.all().empty()) ImGui::Separator();
    for (const ScopeLayout& layout : own_layouts_.all()) offer(layout);
    ImGui::Separator();
    if (ImGui::Selectable("Add a pane")) {
      layout_.panes.push_back({PaneKind::time, "Pane", {protocol::Signal::force_N}});
      memory_.emplace_back();
    }
    if (own != nullptr && is_changed && ImGui::Selectable("Save the changes")) own_layouts_.save(layout_);
    if (ImGui::Selectable("Save as...")) {
      name_task_ = NameTask::save;
      name_ = own == nullptr ? std::string{} : layout_.name;
    }
    if (own != nullptr && ImGui::Selectable("Rename...")) {
      name_task_ = NameTask::rename;
      name_ = layout_.name;
    }
    if (own != nullptr && ImGui::Selectable("Delete")) {
      own_layouts_.remove(layout_.name);
      choose_layout(built_in_layouts().front());
    }
    ImGui::EndCombo();
  }
  help_on_hover("Layout",
                "What the panes show. \"paper\" has the paper's figures 11 to 14. Save your own under a name.", style);
  if (name_task_ != NameTask::none) draw_layout_name(style);
}

void ScopePane::draw_layout_name(const Style& style) {
  constexpr char title[] = "layout name";
  const bool renames = name_task_ == NameTask::rename;
  if (!ImGui::IsPopupOpen(title)) {
    ImGui::OpenPopup(title);
    name_refusal_.clear();
  }
  ImGui::SetNextWindowSize({style.points(340), 0});
  ImGui::SetNextWindowPos(ImGui::GetMainViewport()->GetCenter(), ImGuiCond_Always, {0.5f, 0.5f});
  if (!ImGui::BeginPopupModal(title, nullptr, ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoMove)) return;
  text(style.fonts.strong, style.palette->text,
       renames ? fmt::format("Rename \"{}\"", layout_.name) : std::string("Save this layout"));
  if (ImGui::IsWindowAppearing()) ImGui::SetKeyboardFocusHere();
  ImGui::SetNextItemWidth(-1);
  const bool entered = ImGui::InputTextWithHint("##name", "a name", &name_, ImGuiInputTextFlags_EnterReturnsTrue);
  if (!name_refusal_.empty()) wrapped_text(style.palette->caution, name_refusal_);
  const bool confirmed =
      coloured_button(renames ? "Rename" : "Save", style.palette->accent, style.palette->panel, {style.points(100), 0});
  ImGui::SameLine();
  bool is_done = button("Cancel", {style.points(100), 0}) || ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Escape));
  if (!is_done && (confirmed || entered)) {
    name_refusal_ = renames ? own_layouts_.rename(layout_.name, name_) : OwnLayouts::refusal(name_);
    if (name_refusal_.empty()) {
      layout_.name = name_;
      if (!renames) own_layouts_.save(layout_);
      is_done = true;
    }
  }
  if (is_done) {
    name_task_ = NameTask::none;
    ImGui::CloseCurrentPopup();
  }
  ImGui::EndPopup();
}

}  // namespace inkwell::window
