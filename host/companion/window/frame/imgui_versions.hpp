// Common names for ImGui 1.86 (Debian 12) and ImGui 1.89.8 or newer (Debian 13). Only this file and key_feed.cpp depend
// on the ImGui version.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <imgui.h>

#define INKWELL_IMGUI_HAS_KEY_EVENTS (IMGUI_VERSION_NUM >= 18980)
#if !INKWELL_IMGUI_HAS_KEY_EVENTS && IMGUI_VERSION_NUM >= 18700
#error "ImGui 1.87 to 1.89.7 is not supported. Install ImGui 1.86, or 1.89.8 or later."
#endif

namespace inkwell::window {

#if INKWELL_IMGUI_HAS_KEY_EVENTS

using KeyModifiers = ImGuiKeyChord;
inline constexpr KeyModifiers no_modifier = ImGuiMod_None, with_ctrl = ImGuiMod_Ctrl, with_shift = ImGuiMod_Shift,
                              with_alt = ImGuiMod_Alt;
inline constexpr ImGuiKey key_keypad_enter = ImGuiKey_KeypadEnter;

/// Returns the key index for functions such as ImGui::IsKeyPressed().
inline ImGuiKey key_index(ImGuiKey key) { return key; }

/// Allows later items to overlap an item. Call allow_overlap_before_item() before the item and
/// allow_overlap_after_item() after the item.
inline void allow_overlap_before_item() { ImGui::SetNextItemAllowOverlap(); }
inline void allow_overlap_after_item() {}

/// Scales the width of the ellipsis after a change of the font's measures.
inline void scale_ellipsis(ImFont& font, float factor) {
  font.EllipsisWidth *= factor;
  font.EllipsisCharStep *= factor;
}

inline void set_lists(ImDrawData& data, const std::vector<ImDrawList*>& lists) {
  data.CmdLists.resize(static_cast<int>(lists.size()));
  for (std::size_t i = 0; i < lists.size(); ++i) data.CmdLists[static_cast<int>(i)] = lists[i];
  data.CmdListsCount = data.CmdLists.Size;
}

inline std::span<ImDrawList* const> lists_of(const ImDrawData& data) {
  return {data.CmdLists.Data, static_cast<std::size_t>(data.CmdLists.Size)};
}

#else

using KeyModifiers = ImGuiKeyModFlags;
inline constexpr KeyModifiers no_modifier = ImGuiKeyModFlags_None, with_ctrl = ImGuiKeyModFlags_Ctrl,
                              with_shift = ImGuiKeyModFlags_Shift, with_alt = ImGuiKeyModFlags_Alt;
inline constexpr ImGuiKey key_keypad_enter = ImGuiKey_KeyPadEnter;

/// Returns the key index for functions such as ImGui::IsKeyPressed().
inline int key_index(ImGuiKey key) { return ImGui::GetKeyIndex(key); }

/// Allows later items to overlap an item. Call allow_overlap_before_item() before the item and
/// allow_overlap_after_item() after the item.
inline void allow_overlap_before_item() { ImGui::SetItemAllowOverlap(); }
inline void allow_overlap_after_item() { ImGui::SetItemAllowOverlap(); }

/// This version measures the ellipsis when it draws the ellipsis.
inline void scale_ellipsis(ImFont&, float) {}

/// `lists` must outlive `data`.
inline void set_lists(ImDrawData& data, std::vector<ImDrawList*>& lists) {
  data.CmdLists = lists.data();
  data.CmdListsCount = static_cast<int>(lists.size());
}

inline std::span<ImDrawList* const> lists_of(const ImDrawData& data) {
  return {data.CmdLists, static_cast<std::size_t>(data.CmdListsCount)};
}

#endif

}  // namespace inkwell::window
