#include <panes/recording_pane.hpp>

#include <algorithm>
#include <chrono>
#include <utility>

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <imgui_stdlib.h>

#include <device/parameter_file.hpp>
#include <frame/inspection.hpp>
#include <recording/signals.hpp>

namespace inkwell::window {
namespace {

using recording::RecorderStatus;

std::string name_from_time() {
  return fmt::format("inkwell-{:%Y%m%d-%H%M%S}.h5",
                     fmt::localtime(std::chrono::system_clock::to_time_t(std::chrono::system_clock::now())));
}

void number(const char* name, const std::string& value, Colour colour, const Style& style) {
  const float left = ImGui::GetCursorPosX(), width = ImGui::GetContentRegionAvail().x;
  text(style.palette->text_quiet, name);
  ImGui::SameLine(0, 0);
  ImGui::SetCursorPosX(left + 0.45f * width);
  right_text(colour, value, 0.55f * width);
}

}  // namespace

std::vector<std::string> describe_changes(const protocol::ParameterSet& before, const protocol::ParameterSet& now) {
  std::vector<std::string> changes;
  for (std::size_t i = 0; i < protocol::parameter_count; ++i) {
    if (before.values[i] == now.values[i]) continue;
    const auto parameter = static_cast<protocol::Parameter>(i);
    changes.push_back(fmt::format("{} = {}", info(parameter).name, device::format_value(parameter, now.values[i])));
  }
  return changes;
}

std::string time_left(const RecorderStatus& status) {
  if (status.duration_s < 1 || status.bytes == 0) return {};
  const double left_s =
      static_cast<double>(status.free_bytes) / (static_cast<double>(status.bytes) / status.duration_s);
  if (left_s < 120) return fmt::format("room for {:.0f} s", left_s);
  if (left_s < 7200) return fmt::format("room for {:.0f} min", left_s / 60);
  return left_s < 48 * 3600.0 ? fmt::format("room for {:.0f} h", left_s / 3600) : "room for days";
}

void RecordingPane::start(const DeviceView& view, const std::vector<protocol::Signal>& scope_signals) {
  start_error_.clear();
  last_status_.reset();
  signals_ = choice_ == Choice::standard ? recording::standard_signals()
             : choice_ == Choice::path   ? recording::signal_path()
                                         : std::vector<protocol::Signal>{};
  for (const auto signal : scope_signals)
    if (std::find(signals_.begin(), signals_.end(), signal) == signals_.end() &&
        signals_.size() < protocol::scope_signals_maximum)
      signals_.push_back(signal);
  written_file_ = file_.empty() ? name_from_time() : typed_path(std::filesystem::current_path(), file_).string();
  if (!std::filesystem::path(written_file_).has_extension()) written_file_ += ".h5";
  try {
    if (may_be_replaced_ == written_file_) {
      std::error_code error;  // if it cannot be removed, the recorder says that it exists
      std::filesystem::remove(written_file_, error);
    }
    may_be_replaced_.reset();
    const auto about =
        recording::describe(*view.status.information, *view.parameters, signals_, "", view.status.is_simulation);
    recorder_ = std::make_unique<recording::Recorder>(written_file_, about);
    parameters_ = *view.parameters;
  } catch (const device::Error& error) {
    start_error_ = error.what();
  }
}

void RecordingPane::stop() {
  last_status_ = recorder_->stop();
  recorder_.reset();
  signals_.clear();
  file_.clear();
}

void RecordingPane::mark_changes(const protocol::ParameterSet& now) {
  for (const auto& change : describe_changes(parameters_, now)) recorder_->mark(change);
  parameters_ = now;
}

void RecordingPane::follow(const DeviceView& view, const std::vector<device::ScopeSamples>& frames) {
  if (!recorder_) return;
  for (const auto& samples : frames) recorder_->push(samples);
  if (view.parameters && *view.parameters != parameters_) mark_changes(*view.parameters);
  const bool went_away = !view.connected();
  if (!went_away && recorder_->status().running) return;
  stop();
  if (went_away && last_status_->error.empty())
    last_status_->error = "The device went away. The recording holds everything up to then.";
}

std::optional<std::filesystem::path> RecordingPane::take_replay_wish() {
  return std::exchange(replay_wish_, std::nullopt);
}

void RecordingPane::draw(ImVec2 place, ImVec2 size, const Style& style, const DeviceView& view, bool scope_is_free,
                         const std::vector<protocol::Signal>& scope_signals) {
  begin_pane("recording", place, size);
  text(style.fonts.strong, style.palette->text, "Record");
  if (recorder_)
    draw_progress(style);
  else
    draw_choice(style, view, scope_is_free, scope_signals);
  ImGui::Dummy({0, style.points(10)});
  text(style.fonts.strong, style.palette->text, "Replay");
  draw_replay(style);
  end_pane();
}

void RecordingPane::draw_choice(const Style& style, const DeviceView& view, bool scope_is_free,
                                const std::vector<protocol::Signal>& scope_signals) {
  const Palette& palette = *style.palette;
  const bool connected = view.connected() && view.status.information && view.parameters;
  wrapped_text(palette.text_quiet, !connected ? "A recording needs a device. Plug one in."
                                   : !scope_is_free
                                       ? "A guide uses the scope. Finish or cancel it first."
                                       : "Every control period, with the parameters, into HDF5 (.h5) or CSV.");
  const float button_width = style.points(74);
  ImGui::SetNextItemWidth(ImGui::GetContentRegionAvail().x - button_width - ImGui::GetStyle().ItemSpacing.x);
  ImGui::InputTextWithHint("##file", "named after the time", &file_);
  note_item("file");
  help_on_hover("File",
                fmt::format("Ends in .h5 or .csv, which chooses the format. This folder is {}.",
                            std::filesystem::current_path().string()),
                style);
  ImGui::SameLine();
  if (button("Choose", {button_width, 0})) {
    task_ = FileTask::record;
    chooser_.ask({.title = "Record into a file",
                  .help = "Its ending chooses the format: HDF5 (.h5) or CSV (.csv).",
                  .button = "Choose",
                  .endings = {".h5", ".csv"},
                  .is_new_file = true,
                  .suggestion = file_.empty() ? name_from_time() : file_});
  }
  static constexpr const char* choices[] = {"What replay and plots need", "The whole signal path",
                                            "What the scope shows"};
  ImGui::SetNextItemWidth(-1);
  int chosen = static_cast<int>(choice_);
  if (ImGui::Combo("##signals", &chosen, choices, 3)) choice_ = static_cast<Choice>(chosen);
  help_on_hover("Signals", "What the scope shows is recorded with them in any case.", style);
  ImGui::BeginDisabled(!connected || !scope_is_free);
  if (coloured_button("Start recording", palette.danger, palette.on_danger, {-1, style.points(34)}))
    start(view, scope_signals);
  ImGui::EndDisabled();
  if (!start_error_.empty()) wrapped_text(palette.danger, start_error_);
  if (!last_status_) return;
  ImGui::Dummy({0, style.points(4)});
  if (last_status_->error.empty())
    wrapped_text(palette.good, fmt::format("{} is complete.", written_file_));
  else
    wrapped_text(palette.danger, last_status_->error);
  draw_numbers(style, *last_status_);
}

void RecordingPane::draw_progress(const Style& style) {
  const Palette& palette = *style.palette;
  wrapped_text(palette.text_quiet, written_file_);
  draw_numbers(style, recorder_->status());
  if (coloured_button("Stop recording", palette.raised_active, palette.text, {-1, style.points(34)})) return stop();
  ImGui::Dummy({0, style.points(4)});
  const float button_width = style.points(64);
  ImGui::SetNextItemWidth(ImGui::GetContentRegionAvail().x - button_width - ImGui::GetStyle().ItemSpacing.x);
  const bool entered =
      ImGui::InputTextWithHint("##mark", "what happens now", &mark_text_, ImGuiInputTextFlags_EnterReturnsTrue);
  note_item("mark text");
  ImGui::SameLine();
  if (button("Mark", {button_width, 0}) || entered) {
    recorder_->mark(mark_text_.empty() ? fmt::format("mark {}", recorder_->status().marks + 1) : mark_text_);
    mark_text_.clear();
  }
  help_on_hover("Mark", "Notes this moment in the recording. Changes of parameters are noted by themselves.", style);
}

void RecordingPane::draw_numbers(const Style& style, const RecorderStatus& status) {
  const Palette& palette = *style.palette;
  number("Duration", fmt::format("{:.1f} s", status.duration_s), palette.text, style);
  number("Size", size_text(status.bytes), palette.text, style);
  number("Lost", fmt::format("{} of {} samples", status.lost, status.samples + status.lost),
         status.lost > 0 ? palette.caution : palette.text, style);
  number("Marks", fmt::format("{}", status.marks), palette.text, style);
  const auto left = status.running ? time_left(status) : std::string();
  number("Free", size_text(status.free_bytes) + (left.empty() ? "" : ", " + left),
         status.free_bytes < 500'000'000 ? palette.caution : palette.text, style);
}

void RecordingPane::draw_replay(const Style& style) {
  const auto replay = [this](const std::filesystem::path& file) {
    replay_error_.clear();
    replay_wish_ = file;
  };
  if (button("Open a recording", {-1, style.points(30)})) {
    task_ = FileTask::replay;
    chooser_.ask({.title = "Replay a recording",
                  .help = "It plays in place of the device, with its parameters, signals and marks.",
                  .button = "Open",
                  .endings = {".h5", ".csv"},
                  .suggestion = written_file_});
  }
  if (!recorder_ && last_status_ && button("Replay the last one", {-1, style.points(30)})) replay(written_file_);
  if (!replay_error_.empty()) wrapped_text(style.palette->danger, replay_error_);
  const auto chosen = chooser_.draw(style);
  if (!chosen) return;
  if (task_ == FileTask::replay) return replay(*chosen);
  file_ = chosen->string();
  may_be_replaced_ = *chosen;  // the chooser asked, if there is such a file
}

}  // namespace inkwell::window
