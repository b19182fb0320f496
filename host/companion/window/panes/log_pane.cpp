// The pane lists events with UTC time and board time. During a replay, the pane shows the events of the recording.
// Otherwise the pane shows the events of the device.
#include <algorithm>
#include <array>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "host/client/recording/write_text.hpp"
#include "host/companion/window/frame/file_chooser.hpp"
#include "host/companion/window/frame/inspection.hpp"
#include "host/companion/window/frame/keyboard.hpp"
#include "host/companion/window/frame/widgets.hpp"
#include "host/companion/window/panes/pane.hpp"
#include "protocol/reports.hpp"

namespace inkwell::window {
namespace {

using device::EventKind;

constexpr std::array<const char*, device::event_kind_count + 1> shown_kinds{
    "All events", "Marks",  "Connections", "Force on and off", "Faults",
    "Parameters", "Losses", "Buttons",     "Force sources",    "Shapes"};

/// One row of the log.
struct LogRow {
  EventKind kind;
  const std::string& text;
  const std::string& clock_utc;
  std::optional<double> board_s;  ///< empty: no device was connected
};

/// Returns "22:15:34.123" for "2026-11-23T22:15:34.123Z"; empty for other formats.
std::string_view time_of_day(std::string_view clock_utc) {
  constexpr std::size_t date_length = 11, time_length = 12;
  return clock_utc.size() < date_length + time_length ? std::string_view{} : clock_utc.substr(date_length, time_length);
}

class LogPane final : public Pane {
 public:
  explicit LogPane(const PaneSurroundings& around)
      : desk_(around.desk), replayed_(around.replayed), seek_(around.seek) {}

  std::string_view title() const override { return "Log"; }
  void draw(const PaneFrame& frame) override;

 private:
  bool is_shown(EventKind kind) const { return shown_ == 0 || static_cast<int>(kind) + 1 == shown_; }
  void draw_head(const Style& style);
  void draw_rows(const Style& style);
  void draw_row(const LogRow& row, const Style& style);
  void draw_saving(const Style& style);
  std::string as_text() const;

  DeviceDesk& desk_;
  std::function<const recording::StoredRecording*()> replayed_;
  std::function<void(double)> seek_;
  int shown_ = 0;  ///< index into shown_kinds
  FileChooser chooser_;
  std::string saved_;  ///< message about the saved file
  std::string problem_;
};

Colour colour_of(EventKind kind, const Palette& palette) {
  switch (kind) {
    case EventKind::fault: return palette.danger_text;
    case EventKind::loss: return palette.caution;
    case EventKind::force: return palette.good;
    default: return palette.text_quiet;
  }
}

void LogPane::draw(const PaneFrame& frame) {
  const Style& style = frame.style;
  draw_head(style);
  const float buttons = ImGui::GetFrameHeightWithSpacing() + style.points(4);
  if (ImGui::BeginChild("rows", {0, -buttons}, false, ImGuiWindowFlags_NavFlattened)) {
    scroll_by_page_keys();
    draw_rows(style);
  }
  ImGui::EndChild();
  draw_saving(style);
}

void LogPane::draw_head(const Style& style) {
  text(style.fonts.strong, style.palette->text, replayed_() ? "Events in the recording" : "Events");
  ImGui::SetNextItemWidth(-1);
  ImGui::Combo("##kinds", &shown_, shown_kinds.data(), static_cast<int>(shown_kinds.size()));
  note_item("kinds");
}

void LogPane::draw_rows(const Style& style) {
  bool is_empty = true;
  const auto draw = [&](const LogRow& row) {
    if (!is_shown(row.kind)) return;
    is_empty = false;
    draw_row(row, style);
  };
  if (const recording::StoredRecording* recording = replayed_()) {
    for (const recording::Mark& mark : recording->marks)  // in chronological order
      draw({mark.kind, mark.text, mark.clock_utc, recording->elapsed_s_at(mark.period)});
  } else {
    const device::EventLog& events = desk_.events();
    for (std::uint64_t number = events.end(); number > events.begin(); --number) {
      const device::Event& event = events[number - 1];
      draw({event.kind, event.text, event.clock_utc,
            event.at_periods ? std::optional(device::board_time_s(*event.at_periods)) : std::nullopt});
    }
  }
  if (is_empty)
    wrapped_text(style.palette->text_quiet,
                 "No events yet. Faults, losses, parameter changes, connections and force on/off are logged here and "
                 "in a running recording.");
}

void LogPane::draw_row(const LogRow& row, const Style& style) {
  const Palette& palette = *style.palette;
  const ImVec2 corner = ImGui::GetCursorScreenPos();
  const float width = ImGui::GetContentRegionAvail().x;
  ImGui::BeginGroup();
  ImGui::PushFont(style.fonts.caption);
  text(colour_of(row.kind, palette), name_of(row.kind));
  ImGui::SameLine(style.points(82));
  text(palette.text_quiet, time_of_day(row.clock_utc));
  if (row.board_s) {
    ImGui::SameLine(0, 0);
    ImGui::SetCursorPosX(style.points(170));
    right_text(palette.text_quiet, fmt::format("{:.5f} s", *row.board_s), width - style.points(170));
  }
  ImGui::PopFont();
  wrapped_text(palette.text, row.text);
  ImGui::EndGroup();
  const ImVec2 end{corner.x + width, ImGui::GetItemRectMax().y};
  ImGui::Dummy({0, style.points(1)});
  if (!replayed_() || !row.board_s || !ImGui::IsWindowHovered() || !ImGui::IsMouseHoveringRect(corner, end)) return;
  ImGui::GetWindowDrawList()->AddRectFilled(corner, end, packed(palette.accent.with_alpha(30)), style.points(4));
  if (ImGui::IsMouseClicked(ImGuiMouseButton_Left)) seek_(*row.board_s);
}

std::string LogPane::as_text() const {
  if (const recording::StoredRecording* recording = replayed_()) return recording::log_text(*recording);
  std::string text;
  const device::EventLog& events = desk_.events();
  for (std::uint64_t number = events.begin(); number < events.end(); ++number) text += device::line_of(events[number]);
  return text;
}

void LogPane::draw_saving(const Style& style) {
  if (button("Save as text", {-1, 0})) {
    saved_.clear();
    problem_.clear();
    chooser_.ask({.title = "Save the log",
                  .help = "One line per event: UTC time, board time, kind and text.",
                  .button = "Save",
                  .endings = {".txt"},
                  .is_new_file = true,
                  .suggestion = "inkwell-log.txt"});
  }
  help_on_hover("Save as text", saved_.empty() ? "Saves all events with UTC time and board time." : saved_, style);
  const auto chosen = chooser_.draw(style);
  if (chosen) try {
      recording::write_text(*chosen, as_text());
      saved_ = fmt::format("{} was saved.", chosen->filename().string());
    } catch (const device::Error& error) {
      problem_ = error.what();
    }
  if (!problem_.empty()) wrapped_text(style.palette->danger_text, problem_);
}

}  // namespace

std::unique_ptr<Pane> log_pane(const PaneSurroundings& around) { return std::make_unique<LogPane>(around); }

}  // namespace inkwell::window
