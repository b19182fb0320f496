#include "host/companion/window/frame/file_chooser.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <imgui_stdlib.h>

#include "host/companion/window/frame/imgui_versions.hpp"
#include "host/companion/window/frame/inspection.hpp"
#include "host/companion/window/frame/widgets.hpp"

namespace inkwell::window {

namespace fs = std::filesystem;

namespace {
constexpr char dialog[] = "choose a file";
constexpr double list_again_after_s = 1.0;
}  // namespace

void FileChooser::ask(FileQuestion question) {
  question_ = std::move(question);
  is_asked_ = true;
  shows_all_files_ = false;
  to_be_replaced_.reset();
  std::error_code error;
  const fs::path suggestion = fs::absolute(question_.suggestion.empty() ? "." : question_.suggestion, error);
  const bool is_folder = fs::is_directory(suggestion, error);
  enter((is_folder ? suggestion : suggestion.parent_path()).lexically_normal());
  typed_ = is_folder ? std::string() : suggestion.filename().string();
}

void FileChooser::enter(const fs::path& folder) {
  folder_ = folder;
  problem_.clear();
  typed_.clear();
  listed_at_s_ = -list_again_after_s;
}

/// Draws a button for each parent folder.
void FileChooser::draw_folders(const Style& style) {
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, ImVec2{style.points(2), style.points(4)});
  ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, ImVec2{style.points(4), style.points(4.5f)});
  fs::path folder;
  std::optional<fs::path> wanted;
  for (const fs::path& part : folder_) {
    if (part.empty()) continue;
    folder /= part;
    const std::string label = part == folder_.root_path() ? "/" : part.string();
    if (folder != folder.root_path()) same_line_if_room(ImGui::CalcTextSize(label.c_str()).x + style.points(8));
    if (quiet_button((label + "##" + folder.string()).c_str(), style)) wanted = folder;
  }
  ImGui::PopStyleVar(2);
  if (wanted) enter(*wanted);
}

bool FileChooser::draw_filter(const Style& style) {
  if (question_.endings.empty()) return false;
  const std::string these = fmt::format("{} files", fmt::join(question_.endings, ", "));
  int all = shows_all_files_ ? 1 : 0;
  const std::array<const char*, 2> names{these.c_str(), "All files"};
  ImGui::SetNextItemWidth(style.points(150));
  if (!ImGui::Combo("##filter", &all, names.data(), static_cast<int>(names.size()))) return false;
  shows_all_files_ = all == 1;
  return true;
}

void FileChooser::draw_entries(const Style& style) {
  if (ImGui::GetTime() - listed_at_s_ > list_again_after_s) {
    listing_ = list_folder(folder_, shows_all_files_ ? std::span<const std::string>{} : question_.endings);
    listed_at_s_ = ImGui::GetTime();
  }
  const Palette& palette = *style.palette;
  ImGui::PushStyleColor(ImGuiCol_ChildBg, packed(palette.ground));
  ImGui::BeginChild("entries", {0, style.points(236)}, false,
                    ImGuiWindowFlags_AlwaysUseWindowPadding | ImGuiWindowFlags_NavFlattened);
  std::optional<fs::path> wanted;
  const float width = ImGui::GetContentRegionAvail().x;
  const auto column = [&](const std::string& content, float right_points) {
    ImGui::SameLine(0, 0);
    ImGui::SetCursorPosX(0);
    right_text(palette.text_quiet, content, width - style.points(right_points));
  };
  if (folder_ != folder_.root_path() && ImGui::Selectable("..", false, ImGuiSelectableFlags_DontClosePopups))
    wanted = folder_.parent_path();
  for (const FolderEntry& entry : listing_.entries) {
    need_glyphs(entry.name);
    const std::string label = entry.is_folder ? entry.name + "/" : entry.name;
    const bool is_typed = !entry.is_folder && entry.name == typed_;
    ImGui::PushStyleColor(ImGuiCol_Header, packed(palette.accent.with_alpha(70)));
    constexpr int flags = ImGuiSelectableFlags_DontClosePopups | ImGuiSelectableFlags_AllowDoubleClick;
    const bool pressed = ImGui::Selectable(label.c_str(), is_typed, flags);
    ImGui::PopStyleColor();
    if (pressed && entry.is_folder) wanted = folder_ / entry.name;
    if (pressed && !entry.is_folder) {
      typed_ = entry.name;
      problem_.clear();
      if (ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left)) accept();
    }
    if (!entry.is_folder) column(size_text(entry.bytes), 130);
    column(date_text(entry.changed), 0);
  }
  if (!listing_.problem.empty())
    wrapped_text(palette.caution, listing_.problem);
  else if (listing_.entries.empty())
    text(palette.text_quiet, shows_all_files_ || question_.endings.empty() ? "This folder is empty."
                                                                           : "This folder has no files of this type.");
  ImGui::EndChild();
  ImGui::PopStyleColor();
  if (wanted) enter(*wanted);
}

/// Opens the typed folder or chooses the typed file.
void FileChooser::accept() {
  if (typed_.empty()) return;
  const fs::path typed = typed_path(folder_, typed_);
  std::error_code error;
  if (fs::is_directory(typed, error)) return enter(typed.has_filename() ? typed : typed.parent_path());
  if (!question_.is_new_file) {
    problem_ = reading_problem(typed);
    if (problem_.empty()) chosen_ = typed;
    return;
  }
  const fs::path file = with_ending(typed, question_.endings);
  problem_ = writing_problem(file);
  if (!problem_.empty()) return;
  if (fs::exists(file, error))
    to_be_replaced_ = file;
  else
    chosen_ = file;
}

/// Returns true if the user cancels the dialog.
bool FileChooser::draw_buttons(const Style& style) {
  const ImVec2 size{style.points(100), 0};
  if (to_be_replaced_) {
    wrapped_text(style.palette->caution,
                 fmt::format("The file {} already exists. Replace the file?", to_be_replaced_->filename().string()));
    if (grave_button("Replace", style, size)) chosen_ = std::exchange(to_be_replaced_, std::nullopt);
    ImGui::SameLine();
    if (button("Keep file", size) || ImGui::IsKeyPressed(key_index(ImGuiKey_Escape))) to_be_replaced_.reset();
    return false;
  }
  if (primary_button(question_.button.c_str(), style, size)) accept();
  ImGui::SameLine();
  return button("Cancel", size) || ImGui::IsKeyPressed(key_index(ImGuiKey_Escape));
}

std::optional<fs::path> FileChooser::draw(const Style& style) {
  if (!is_asked_) return std::nullopt;
  if (!ImGui::IsPopupOpen(dialog)) ImGui::OpenPopup(dialog);
  const ImVec2 room = ImGui::GetMainViewport()->Size;
  ImGui::SetNextWindowSize({std::min(style.points(560), room.x), 0});
  ImGui::SetNextWindowPos(ImGui::GetMainViewport()->GetCenter(), ImGuiCond_Always, {0.5f, 0.5f});
  if (!ImGui::BeginPopupModal(dialog, nullptr, ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoMove))
    return std::nullopt;
  text(style.fonts.strong, style.palette->text, question_.title);
  wrapped_text(style.palette->text_quiet, question_.help);
  draw_folders(style);
  draw_entries(style);
  if (ImGui::IsWindowAppearing()) ImGui::SetKeyboardFocusHere();
  ImGui::SetNextItemWidth(question_.endings.empty() ? -1.0f : -style.points(158));
  ImGui::BeginDisabled(to_be_replaced_.has_value());
  need_glyphs(typed_);
  const bool entered = ImGui::InputTextWithHint("##path", question_.is_new_file ? "file name" : "file name or path",
                                                &typed_, ImGuiInputTextFlags_EnterReturnsTrue);
  note_item("path");
  ImGui::EndDisabled();
  if (!question_.endings.empty()) ImGui::SameLine();
  if (draw_filter(style)) listed_at_s_ = -list_again_after_s;
  if (!problem_.empty()) wrapped_text(style.palette->caution, problem_);
  const bool is_cancelled = draw_buttons(style);
  if (entered) accept();
  if (chosen_ || is_cancelled) {
    is_asked_ = false;
    ImGui::CloseCurrentPopup();
  }
  ImGui::EndPopup();
  return std::exchange(chosen_, std::nullopt);
}

}  // namespace inkwell::window
