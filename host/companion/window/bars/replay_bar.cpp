#include "host/companion/window/bars/replay_bar.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <tuple>
#include <utility>

#include <fmt/format.h>

#include "host/companion/window/frame/imgui_versions.hpp"
#include "host/companion/window/frame/inspection.hpp"
#include "host/companion/window/frame/keyboard.hpp"
#include "host/companion/window/frame/widgets.hpp"

namespace inkwell::window {
namespace {

constexpr std::array<double, 7> speeds{0.01, 0.05, 0.2, 0.5, 1.0, 2.0, 4.0};

std::string speed_label(double speed) { return fmt::format("{:g} x", speed); }

}  // namespace

void ReplayBar::open(const std::filesystem::path& file) {
  replay_.emplace(recording::StoredRecording::open(file));
  replay_->play();
  file_ = file;
  name_ = replay_->recording().name;
  over_.reset();
  problem_.clear();
  editor_ = {};
  editor_.device_holds(replay_->recording().information.parameters);
}

void ReplayBar::lay_over(const std::filesystem::path& file, const std::string& mark) {
  recording::StoredRecording over = recording::StoredRecording::open(file);
  std::string name;
  std::tie(name, over.name) = recording::distinct_names(file_, file);
  over_.emplace(std::move(over), replay_->recording(), mark);
  name_ = std::move(name);
  aligned_at_ = mark;
  replay_->seek(replay_->position_s());  // fills the scope with both recordings
}

void ReplayBar::align_at(const std::string& mark) {
  over_.emplace(recording::StoredRecording(over_->recording()), replay_->recording(), mark);
  aligned_at_ = mark;
  replay_->seek(replay_->position_s());
}

void ReplayBar::follow(double now_s, ScopePane& scope) {
  const double passed_s = now_s - followed_until_s_.value_or(now_s);
  followed_until_s_ = now_s;
  if (!replay_) return;
  editor_.take_changes();
  editor_.forget_unconfirmed(now_s);
  try {
    const bool has_other_signals = select_signals(scope);
    auto passed = replay_->advance(passed_s, scope.span_s());
    if (passed.is_restart)
      scope.restart();
    else if (has_other_signals)
      refill(scope);
    for (const ReceivedBlock& block : with_over(std::move(passed.blocks)))
      scope.receive(block.samples, block.over ? &*block.over : nullptr);
  } catch (const device::Error& error) {
    stop_at(error);
  }
}

bool ReplayBar::select_signals(const ScopePane& scope) {
  const std::vector<protocol::Signal> shown = scope.signals();
  const bool over_has_changed = over_ && over_->select(shown);
  return replay_->select(shown) || over_has_changed;
}

void ReplayBar::refill(ScopePane& scope) const {
  const SignalHistory& history = scope.history();
  const auto held = static_cast<std::int64_t>(history.end() - history.begin());
  scope.refill(with_over(replay_->between(history.next_period() - held, history.next_period())));
}

std::vector<ReceivedBlock> ReplayBar::with_over(std::vector<device::ScopeSamples> blocks) const {
  std::vector<ReceivedBlock> received;
  for (device::ScopeSamples& block : blocks) {
    ReceivedBlock& each = received.emplace_back(std::move(block), std::nullopt);
    if (over_) each.over = over_->compared_with(each.samples);
  }
  return received;
}

std::optional<device::Pose> ReplayBar::pose() try { return replay_->pose(); } catch (const device::Error& error) {
  stop_at(error);
  return std::nullopt;
}

/// The samples are read during the replay, so damage in the middle of a file is found late.
void ReplayBar::stop_at(const device::Error& error) {
  replay_->pause();
  problem_ = error.what();
}

void ReplayBar::draw(ImVec2 origin, ImVec2 size, const Style& style, ScopePane& scope) {
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2{style.points(12), style.points(9)});
  begin_pane("replay", origin, size, ImGuiWindowFlags_NoScrollWithMouse);
  ImGui::PopStyleVar();
  draw_controls(std::max(style.points(100), 0.34f * size.x - style.points(60)), style);
  ImGui::SameLine(0, style.points(14));
  draw_over(style);
  ImGui::SameLine(0, style.points(14));

  const float close_width = style.points(104), time_width = style.points(104), gap = style.points(12);
  const ImVec2 corner = ImGui::GetCursorScreenPos();
  const float right = origin.x + size.x - style.points(12) - close_width - gap - time_width - gap;
  if (right - corner.x > style.points(40)) draw_track(corner, {right - corner.x, ImGui::GetFrameHeight()}, style);
  ImGui::SetCursorScreenPos({right + gap, corner.y});
  ImGui::AlignTextToFramePadding();
  right_text(style.palette->text_quiet, fmt::format("{:.2f} of {:.2f} s", replay_->position_s(), replay_->duration_s()),
             time_width);
  ImGui::SetCursorScreenPos({right + gap + time_width + gap, corner.y});
  const bool is_to_be_closed = button("Close replay", {close_width, 0});
  help_on_hover("Close replay", "Closes the replay and shows the device.", style);
  end_pane();
  if (!is_to_be_closed) return;
  replay_.reset();
  over_.reset();
  scope.restart();
}

void ReplayBar::draw_controls(float name_room, const Style& style) {
  if (button(replay_->is_playing() ? "Pause###play" : "Play###play", {style.points(62), 0})) toggle_play();
  help_on_hover("", "Key: Ctrl+P", style);
  ImGui::SameLine();
  ImGui::SetNextItemWidth(style.points(76));
  if (ImGui::BeginCombo("##speed", speed_label(replay_->speed()).c_str())) {
    for (const double speed : speeds)
      if (ImGui::Selectable(speed_label(speed).c_str(), speed == replay_->speed())) replay_->set_speed(speed);
    ImGui::EndCombo();
  }
  help_on_hover("Speed", "Replay speed relative to the recording.", style);
  ImGui::SameLine();
  ImGui::AlignTextToFramePadding();
  const auto& recording = replay_->recording();
  std::string name = name_;
  if (recording.information.simulation) name += " (simulation)";
  if (!recording.complete) name += ", incomplete";
  text(style.fonts.strong, style.palette->text, fitted(name, name_room));
  if (recording.remarks.empty())
    help_on_hover(name, file_.string(), style);
  else
    help_on_hover("Ignored content", fmt::format("{}", fmt::join(recording.remarks, "\n")), style);
}

/// Draws the controls for the overlaid recording.
void ReplayBar::draw_over(const Style& style) {
  if (!over_) {
    if (button("Overlay", {style.points(74), 0}))
      chooser_.ask({.title = "Overlay a second recording",
                    .help = "The plots draw the second recording in paler colors.",
                    .button = "Overlay",
                    .endings = {".h5", ".csv"},
                    .suggestion = std::filesystem::current_path()});
    help_on_hover("Overlay", problem_.empty() ? "Adds a second recording to the plots, in paler colors." : problem_,
                  style);
    if (!problem_.empty()) {
      ImGui::SameLine();
      const ImVec2 corner = ImGui::GetCursorScreenPos();
      ImGui::Dummy({warning_sign(corner, style.palette->caution, style), 0});
    }
  } else {
    ImGui::SetNextItemWidth(style.points(150));
    const std::string shown = fitted(over_->recording().name, style.points(112));
    if (ImGui::BeginCombo("##over", shown.c_str())) {
      text(style.palette->text_quiet, "Align at");
      if (ImGui::Selectable("start", aligned_at_.empty())) align_at({});
      for (const std::string& mark : recording::common_marks(replay_->recording(), over_->recording())) {
        need_glyphs(mark);
        if (ImGui::Selectable(mark.c_str(), aligned_at_ == mark)) align_at(mark);
      }
      ImGui::Separator();
      const bool goes = ImGui::Selectable("Remove overlay");
      note_item("Remove overlay");
      ImGui::EndCombo();
      if (goes) {
        over_.reset();
        name_ = replay_->recording().name;
        replay_->seek(replay_->position_s());
        return;
      }
    }
    note_item("over");
    note_text(shown);
    help_on_hover("Overlaid recording", over_->recording().name, style);
  }
  if (const auto chosen = chooser_.draw(style)) try {
      problem_.clear();
      lay_over(*chosen, {});
    } catch (const device::Error& error) {
      problem_ = error.what();
    }
}

/// Draws the replay track with the marks of the recording. A click or a drag changes the replay position.
void ReplayBar::draw_track(ImVec2 corner, ImVec2 size, const Style& style) {
  const Palette& palette = *style.palette;
  const auto& recording = replay_->recording();
  const float mouse = ImGui::GetIO().MousePos.x;
  ImDrawList& list = *ImGui::GetWindowDrawList();
  ImGui::SetCursorScreenPos(corner);
  ImGui::InvisibleButton("track", size);
  note_item("track");
  const double duration_s = std::max(replay_->duration_s(), 1.0 / protocol::servo_rate_Hz);
  if (ImGui::IsItemActive() && ImGui::IsMouseDown(ImGuiMouseButton_Left))
    replay_->seek(duration_s * static_cast<double>((mouse - corner.x) / size.x));
  constexpr double step_part = 0.01;  // of the recording, per key press
  if (const int steps = key_steps_in_part(with_shift).right; steps != 0)
    replay_->seek(std::clamp(replay_->position_s() + step_part * steps * duration_s, 0.0, duration_s));

  const auto x_of = [&](double at_s) { return corner.x + static_cast<float>(at_s / duration_s) * size.x; };
  const float middle = corner.y + 0.5f * size.y, half = style.points(3), x = x_of(replay_->position_s());
  list.AddRectFilled({corner.x, middle - half}, {corner.x + size.x, middle + half}, packed(palette.raised), half);
  list.AddRectFilled({corner.x, middle - half}, {x, middle + half}, packed(palette.accent), half);
  const recording::Mark* nearest = nullptr;
  float nearest_pixels = style.points(6);
  for (const auto& mark : recording.marks) {
    const float at = x_of(recording.elapsed_s_at(mark.period));
    list.AddRectFilled({at - style.points(1), middle - style.points(8)},
                       {at + style.points(1), middle + style.points(8)}, packed(palette.caution));
    if (!ImGui::IsItemHovered() || std::abs(mouse - at) >= nearest_pixels) continue;
    nearest = &mark;
    nearest_pixels = std::abs(mouse - at);
  }
  list.AddCircleFilled({x, middle}, style.points(7), packed(palette.text));
  if (nearest != nullptr)
    help_on_hover(fmt::format("{:.3f} s", recording.elapsed_s_at(nearest->period)), nearest->text, style);
}

}  // namespace inkwell::window
