#include "host/companion/window/frame/keyboard.hpp"
#include "host/companion/window/frame/imgui_versions.hpp"

#include <algorithm>
#include <cstdlib>
#include <utility>
#include <vector>

#include <imgui_internal.h>

namespace inkwell::window {

namespace {

bool can_have_keyboard(const ImGuiWindow& part) {
  constexpr ImGuiWindowFlags cannot = ImGuiWindowFlags_NoNavFocus | ImGuiWindowFlags_Tooltip | ImGuiWindowFlags_Popup;
  return part.WasActive && part.RootWindow == &part && (part.Flags & cannot) == 0;
}

/// Returns the focusable panes in drawing order.
std::vector<ImGuiWindow*> parts() {
  std::vector<ImGuiWindow*> found;
  for (ImGuiWindow* each : GImGui->Windows)
    if (can_have_keyboard(*each)) found.push_back(each);
  std::ranges::sort(found, {}, &ImGuiWindow::BeginOrderWithinContext);
  return found;
}

bool is_menu_open() { return ImGui::IsPopupOpen("", ImGuiPopupFlags_AnyPopupId | ImGuiPopupFlags_AnyPopupLevel); }

void show_keyboard() {
  ImGuiContext& context = *GImGui;
  context.NavDisableHighlight = false;
  context.NavDisableMouseHover = true;
  context.NavInputSource = ImGuiInputSource_Keyboard;
}

}  // namespace

void KeyboardTour::focus_window(ImGuiWindow& part) {
  ImGuiWindow* last = part.NavLastChildNavWindow;
  ImGuiWindow& into = last != nullptr && last->WasActive ? *last : part;
  ImGui::FocusWindow(&into);
  if (into.NavLastIds[0] == 0) ImGui::NavInitWindow(&into, false);
  show_keyboard();
}

void KeyboardTour::begin_frame() {
  const int steps = std::exchange(steps_, 0);
  if (is_menu_open()) {
    wanted_.clear();
    return;
  }
  for (int i = 0; i < std::abs(steps); ++i) go_on_now(steps < 0);
  ImGuiWindow* wanted = wanted_.empty() ? nullptr : ImGui::FindWindowByName(wanted_.c_str());
  if (wanted != nullptr && wanted->WasActive) {
    wanted_.clear();
    focus_window(*wanted);
  }
  if (std::exchange(last_thing_is_gone_, false) && GImGui->NavWindow != nullptr)
    ImGui::NavInitWindow(GImGui->NavWindow, true);
}

void KeyboardTour::go_on_now(bool backwards) {
  std::vector<ImGuiWindow*> all = parts();
  if (all.empty()) return;
  if (backwards) std::ranges::reverse(all);
  ImGuiWindow* now = GImGui->NavWindow != nullptr ? GImGui->NavWindow->RootWindow : nullptr;
  const auto found = std::ranges::find(all, now);
  const bool is_last = found == all.end() || found + 1 == all.end();
  focus_window(is_last ? *all.front() : **(found + 1));
}

void KeyboardTour::end_frame(const Style& style) {
  const ImGuiContext& context = *GImGui;
  last_thing_is_gone_ = context.NavId != 0 && !context.NavIdIsAlive && !context.NavDisableHighlight && !is_menu_open();
  if (context.NavDisableHighlight || context.NavWindow == nullptr || is_menu_open()) return;
  const ImGuiWindow& part = *context.NavWindow->RootWindow;
  if (!part.Active || (part.Flags & ImGuiWindowFlags_NoNavFocus) != 0) return;
  const float inside = style.points(1);
  ImGui::GetForegroundDrawList()->AddRect({part.Pos.x + inside, part.Pos.y + inside},
                                          {part.Pos.x + part.Size.x - inside, part.Pos.y + part.Size.y - inside},
                                          packed(style.palette->accent.with_alpha(150)), 0, 0, style.points(1));
}

bool is_pressed_by_keyboard() {
  const ImGuiID item = GImGui->LastItemData.ID;
  return item != 0 && item == GImGui->NavActivatePressedId;
}

KeySteps key_steps(KeyModifiers modifiers) {
  const ImGuiIO& io = ImGui::GetIO();
  if (io.KeyMods != modifiers || io.WantTextInput || is_menu_open()) return {};
  const auto pressed = [&io](ImGuiKey key) {
    return ImGui::GetKeyPressedAmount(key_index(key), io.KeyRepeatDelay, io.KeyRepeatRate);
  };
  return {.right = pressed(ImGuiKey_RightArrow) - pressed(ImGuiKey_LeftArrow),
          .up = pressed(ImGuiKey_UpArrow) - pressed(ImGuiKey_DownArrow),
          .away = pressed(ImGuiKey_PageUp) - pressed(ImGuiKey_PageDown)};
}

KeySteps key_steps_in_part(KeyModifiers modifiers) {
  return ImGui::IsWindowFocused(ImGuiFocusedFlags_RootAndChildWindows) ? key_steps(modifiers) : KeySteps{};
}

void keep_modified_arrows() {
  const ImGuiContext& context = *GImGui;
  if (context.IO.KeyMods != no_modifier && context.NavMoveDir != ImGuiDir_None) ImGui::NavMoveRequestCancel();
}

void scroll_by_page_keys() {
  constexpr float page = 0.9f;  // one line of the previous page remains visible
  const int pages = key_steps_in_part(no_modifier).away;
  if (pages != 0) ImGui::SetScrollY(ImGui::GetScrollY() - page * ImGui::GetWindowHeight() * static_cast<float>(pages));
}

}  // namespace inkwell::window
