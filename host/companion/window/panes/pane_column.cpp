#include "host/companion/window/panes/pane_column.hpp"

#include <algorithm>
#include <cctype>
#include <string>
#include <string_view>

#include <fmt/format.h>

#include "host/companion/window/frame/inspection.hpp"
#include "host/companion/window/frame/widgets.hpp"
#include "host/companion/window/panes/pane_stream.hpp"

#include "host/companion/window/panes/registry.hpp"
#include "host/companion/window/panes/store_bar.hpp"

namespace inkwell::window {

namespace {

constexpr float tabs_points = 40.0f;

// Converts "Tuning" to "tuning".
std::string name_of(const Pane& pane) {
  std::string name{pane.title()};
  std::ranges::transform(name, name.begin(), [](unsigned char letter) { return std::tolower(letter); });
  return name;
}

constexpr float dot_points = 12.0f;  // width of the dot next to the state text

float title_width(const Pane& pane, const Style& style) {
  const std::string_view title = pane.title();
  const std::string running = pane.running();
  const float title_taken = ImGui::CalcTextSize(title.data(), title.data() + title.size()).x;
  return running.empty() ? title_taken
                         : std::max(title_taken, style.points(dot_points) + ImGui::CalcTextSize(running.c_str()).x);
}

// Draws the state text instead of the title.
void draw_running(const std::string& running, ImVec2 corner, ImVec2 end, bool is_shown, const Style& style) {
  const Palette& palette = *style.palette;
  const float width = style.points(dot_points) + ImGui::CalcTextSize(running.c_str()).x;
  const ImVec2 left{0.5f * (corner.x + end.x - width), 0.5f * (corner.y + end.y)};
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddCircleFilled({left.x + style.points(4), left.y}, style.points(4), packed(palette.danger_text));
  list.AddText({left.x + style.points(dot_points), left.y - 0.5f * ImGui::GetFontSize()},
               packed(is_shown ? palette.text : palette.text_quiet), running.c_str());
  note_text(running);
}

bool draw_tab(const Pane& pane, bool is_shown, float width, const Style& style) {
  const float room = width - style.points(8);
  const std::string label = fmt::format("{}##tab", fitted(pane.title(), room));
  const std::string running = pane.running();
  if (running.empty()) return tab_button(label.c_str(), is_shown, style, {width, 0});
  const bool pressed = tab_button(label.c_str(), is_shown, style, {width, 0}, true);
  draw_running(running, ImGui::GetItemRectMin(), ImGui::GetItemRectMax(), is_shown, style);
  help_on_hover(pane.title(), "The recording continues while another pane is shown.", style);
  return pressed;
}

/// Draws the mark into the corner of the last drawn tab.
void mark_values_to_store(const Style& style) {
  const ImVec2 corner{ImGui::GetItemRectMax().x, ImGui::GetItemRectMin().y};
  not_stored_mark({corner.x - style.points(7), corner.y + style.points(7)}, style);
  help_on_hover("", "Some values are not stored on the board and are lost at power-off.", style);
  note_item("values to store");
}

}  // namespace

PaneColumn::PaneColumn(const PaneSurroundings& around) : panes_(make_panes(around)) {
  const auto first = std::ranges::find_if(panes_, [](const auto& pane) { return pane->is_shown_at_start(); });
  if (first != panes_.end()) shown_ = static_cast<std::size_t>(first - panes_.begin());
}

void PaneColumn::follow(const PaneNews& news) {
  for (const auto& pane : panes_) pane->follow(news);
}

void PaneColumn::cancel() {
  for (const auto& pane : panes_) pane->cancel();
}

std::string PaneColumn::show(std::size_t tab) {
  if (tab >= panes_.size()) return {};
  shown_ = tab;
  return panes_[shown_]->take_keyboard() ? std::string() : name_of(*panes_[shown_]);
}

PaneStream PaneColumn::stream(const std::vector<protocol::Signal>& scope_signals) const {
  for (const auto& pane : panes_)
    if (PaneStream stream = pane->stream(); !stream.signals.empty()) return stream;
  std::vector<protocol::Signal> signals = joined(scope_signals, panes_[shown_]->shown_signals());
  for (const auto& pane : panes_) signals = joined(std::move(signals), pane->background_signals());
  return {signals};
}

std::string PaneColumn::why_force_waits() const {
  for (const auto& pane : panes_)
    if (std::string why = pane->why_force_waits(); !why.empty()) return why;
  return {};
}

RecordingControls& PaneColumn::recording_controls() {
  const auto found =
      std::ranges::find_if(panes_, [](const auto& pane) { return pane->recording_controls() != nullptr; });
  return *(*found)->recording_controls();
}

std::string PaneColumn::show(std::string_view title) {
  const auto found = std::ranges::find(panes_, title, [](const auto& pane) { return pane->title(); });
  return show(static_cast<std::size_t>(found - panes_.begin()));
}

void PaneColumn::start_guide(std::string_view name) {
  for (const auto& pane : panes_) pane->start_guide(name);
}

bool PaneColumn::is_moving() const {
  return std::ranges::any_of(panes_, [](const auto& pane) { return pane->is_moving(); });
}

float PaneColumn::draw_tabs(ImVec2 origin, float width, const Style& style) {
  const float height = style.points(tabs_points);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2{style.points(12), style.points(6)});
  begin_pane("tabs", origin, {width, height}, ImGuiWindowFlags_NoScrollWithMouse);
  ImGui::PopStyleVar();
  // Each tab has the width of its title plus an equal share of the spare width.
  const auto count = static_cast<float>(panes_.size());
  float spare = ImGui::GetContentRegionAvail().x - (count - 1.0f) * ImGui::GetStyle().ItemSpacing.x;
  for (const auto& pane : panes_) spare -= title_width(*pane, style);
  for (std::size_t i = 0; i < panes_.size(); ++i) {
    if (i > 0) ImGui::SameLine();
    if (draw_tab(*panes_[i], i == shown_, title_width(*panes_[i], style) + spare / count, style)) shown_ = i;
    if (i != shown_ && panes_[i]->has_values_to_store()) mark_values_to_store(style);
  }
  end_pane();
  return height;
}

void PaneColumn::draw(ImVec2 origin, ImVec2 size, PaneFrame frame) {
  frame.scope_is_free = stream(frame.scope_signals).feeds_scope;
  const float tabs = draw_tabs(origin, size.x, frame.style);
  Pane& pane = *panes_[shown_];
  begin_pane(name_of(pane).c_str(), {origin.x, origin.y + tabs}, {size.x, size.y - tabs});
  pane.draw(frame);
  end_pane();
}

}  // namespace inkwell::window
