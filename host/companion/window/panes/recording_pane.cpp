// The pane records signals and marks, and opens recordings for replay.
#include <algorithm>
#include <chrono>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include "host/client/recording/recorder.hpp"
#include "host/client/recording/signals.hpp"
#include "host/companion/window/frame/background_task.hpp"
#include "host/companion/window/frame/file_chooser.hpp"
#include "host/companion/window/frame/imgui_versions.hpp"
#include "host/companion/window/frame/inspection.hpp"
#include "host/companion/window/frame/widgets.hpp"
#include "host/companion/window/panes/pane.hpp"
#include "host/companion/window/panes/sample_capture.hpp"

namespace inkwell::window {
namespace {

using recording::RecorderStatus;

std::string name_from_time(std::string_view kind = "") {
  return fmt::format("inkwell-{}{:%Y%m%d-%H%M%S}.h5", kind,
                     fmt::localtime(std::chrono::system_clock::to_time_t(std::chrono::system_clock::now())));
}

void number(const char* name, const std::string& value, Colour colour, const Style& style) {
  const float left = ImGui::GetCursorPosX(), width = ImGui::GetContentRegionAvail().x;
  text(style.palette->text_quiet, name);
  ImGui::SameLine(0, 0);
  ImGui::SetCursorPosX(left + 0.45f * width);
  right_text(colour, value, 0.55f * width);
}

/// Returns a text with the time until the disk is full; empty while the time is unknown.
std::string time_left(const RecorderStatus& status) {
  if (status.duration_s < 1 || status.bytes == 0) return {};
  const double left_s =
      static_cast<double>(status.free_bytes) / (static_cast<double>(status.bytes) / status.duration_s);
  if (left_s < 120) return fmt::format("room for {:.0f} s", left_s);
  if (left_s < 7200) return fmt::format("room for {:.0f} min", left_s / 60);
  return left_s < 48 * 3600.0 ? fmt::format("room for {:.0f} h", left_s / 3600) : "room for days";
}

// Only the dot of the button is red, because red buttons are reserved for STOP.
bool record_button(const Style& style) {
  const ImVec2 corner = ImGui::GetCursorScreenPos();
  const float height = style.points(34);
  const float middle = corner.x + 0.5f * (ImGui::GetContentRegionAvail().x - ImGui::CalcTextSize("Start recording").x);
  const bool pressed = button("Start recording###record", {-1, height});
  ImGui::GetWindowDrawList()->AddCircleFilled({middle - style.points(14), corner.y + 0.5f * height}, style.points(5),
                                              packed(style.palette->danger_text));
  return pressed;
}

/// Formats a duration as "2:05".
std::string clock_text(double seconds) {
  const auto whole = static_cast<int>(seconds);
  return fmt::format("{}:{:02}", whole / 60, whole % 60);
}

class RecordingPane final : public Pane, public RecordingControls {
 public:
  explicit RecordingPane(const PaneSurroundings& around)
      : desk_(around.desk), replay_(around.replay), starts_with_replay_(around.starts_with_replay) {}

  std::string_view title() const override { return "Recording"; }
  /// Writes the device's events to the recording. Stops the recording when the device is disconnected.
  void follow(const PaneNews& news) override;
  void draw(const PaneFrame& frame) override;
  /// The recording includes the signals of the scope.
  PaneStream stream() const override { return recorder_ ? PaneStream{signals_, true} : PaneStream{}; }
  std::string running() const override {
    return recorder_ ? clock_text(recorder_->status().duration_s) : std::string();
  }
  bool is_shown_at_start() const override { return starts_with_replay_; }
  /// The captured minute can be replayed.
  std::vector<protocol::Signal> background_signals() const override { return recording::standard_signals(); }
  RecordingControls* recording_controls() override { return this; }

  std::string why_recording_waits(bool scope_is_free) const override;
  std::string recording_clock() const override { return running(); }
  void toggle_recording(const std::vector<protocol::Signal>& scope_signals) override;
  void set_mark() override { mark({}); }
  void save_captured() override;

 private:
  enum class Choice : std::uint8_t { standard, path, scope };

  void start(const std::vector<protocol::Signal>& scope_signals);
  /// Name and note of the next recording.
  recording::Origin origin() const { return {.name = name_, .note = note_, .image = {}, .arm_description = {}}; }
  void draw_texts(const Style& style);
  void stop();
  /// Adds a mark. Without a text, the text has the next number.
  void mark(const std::string& text);
  void capture(const std::vector<device::ScopeSamples>& samples);
  void draw_captured(const Style& style);
  void follow_recording(const std::vector<device::ScopeSamples>& samples);
  void follow_replay_wish();
  void draw_choice(const PaneFrame& frame);
  void draw_progress(const Style& style);
  void draw_numbers(const Style& style, const RecorderStatus& status);
  void draw_replay(const Style& style);
  bool force_is_on() const { return protocol::force_is_on(desk_.view().state()); }
  /// Before a replay, asks the user for permission to switch the force off.
  void draw_question(const Style& style);

  DeviceDesk& desk_;
  std::function<void(const std::filesystem::path&)> replay_;
  bool starts_with_replay_;
  std::string file_;         ///< empty: a name derived from the time
  std::string name_, note_;  ///< stored in the recordings; may be empty
  Choice choice_ = Choice::standard;
  std::string mark_text_;
  std::unique_ptr<recording::Recorder> recorder_;  ///< null while not recording
  std::vector<protocol::Signal> signals_;
  std::uint64_t next_event_ = 0;  ///< first event of the device's log that is not yet in the recording
  std::string written_file_;      ///< file of the current or last recording
  std::optional<RecorderStatus> last_status_;
  std::string start_error_;
  enum class FileTask : std::uint8_t { record, replay } task_ = FileTask::replay;
  FileChooser chooser_;
  std::optional<std::filesystem::path> may_be_replaced_;
  std::string replay_error_;
  SampleCapture capture_;
  std::optional<device::Information> captured_device_;  ///< device of the captured samples
  bool captured_simulation_ = false;
  protocol::ParameterSet captured_parameters_{};
  BackgroundTask capture_writer_;
  std::string captured_file_;    ///< last file of a captured minute
  std::string capture_problem_;  ///< error of the last save; empty: no error
  int marks_ = 0;                ///< number of marks without a text
  struct ReplayWish {
    std::filesystem::path file;
    bool asks;  ///< waiting for the user's permission to switch the force off
  };
  std::optional<ReplayWish> replay_wish_;  ///< empty once the replay has started
};

void RecordingPane::start(const std::vector<protocol::Signal>& scope_signals) {
  const DeviceView& view = desk_.view();
  start_error_.clear();
  last_status_.reset();
  signals_ = choice_ == Choice::standard ? recording::standard_signals()
             : choice_ == Choice::path   ? recording::signal_path()
                                         : std::vector<protocol::Signal>{};
  // The order of the background stream avoids a gap at the start of the recording.
  const auto in_stream_order = joined(scope_signals, signals_);
  signals_ = joined(std::move(signals_), scope_signals);
  if (in_stream_order.size() == signals_.size()) signals_ = in_stream_order;
  written_file_ = file_.empty() ? name_from_time() : typed_path(std::filesystem::current_path(), file_).string();
  if (!std::filesystem::path(written_file_).has_extension()) written_file_ += ".h5";
  try {
    if (may_be_replaced_ == written_file_) {
      std::error_code error;  // if the file cannot be removed, the recorder reports that it exists
      std::filesystem::remove(written_file_, error);
    }
    may_be_replaced_.reset();
    const auto about = recording::describe(*view.status.information, *view.parameters, signals_, "",
                                           view.status.is_simulation, origin());
    recorder_ = std::make_unique<recording::Recorder>(written_file_, about);
    next_event_ = desk_.events().end();
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

void RecordingPane::follow(const PaneNews& news) {
  capture(news.samples);
  if (recorder_) follow_recording(news.samples);
  follow_replay_wish();
  if (const auto result = capture_writer_.take_result()) capture_problem_ = *result;
}

void RecordingPane::capture(const std::vector<device::ScopeSamples>& samples) {
  const DeviceView& view = desk_.view();
  if (view.status.information && view.parameters) {
    if (captured_device_ && captured_device_->serial_number != view.status.information->serial_number) capture_.clear();
    captured_device_ = view.status.information;
    captured_simulation_ = view.status.is_simulation;
    captured_parameters_ = *view.parameters;
  }
  for (const auto& each : samples) capture_.add(each);
}

void RecordingPane::save_captured() {
  if (capture_.is_empty() || !captured_device_ || capture_writer_.is_running()) return;
  CapturedRecording task{.file = std::filesystem::current_path() / name_from_time("last-60-s-"),
                         .information = {},
                         .blocks = capture_.blocks(),
                         .marks = {}};
  task.information = recording::describe(*captured_device_, captured_parameters_, task.blocks.back()->signals, "",
                                         captured_simulation_, origin());
  const device::EventLog& events = desk_.events();
  for (std::uint64_t number = events.begin(); number < events.end(); ++number)
    if (const device::Event& event = events[number];
        event.at_periods && *event.at_periods >= task.blocks.front()->first_period)
      task.marks.push_back({*event.at_periods, event.text, event.kind, event.clock_utc});
  std::ranges::stable_sort(task.marks, {}, &recording::Mark::period);
  captured_file_ = task.file.string();
  capture_problem_.clear();
  capture_writer_.start([task = std::move(task)] { return write_captured(task); });
}

std::string RecordingPane::why_recording_waits(bool scope_is_free) const {
  const DeviceView& view = desk_.view();
  if (!view.connected() || !view.status.information || !view.parameters)
    return "A recording needs a device. Plug in a device.";
  return scope_is_free ? "" : "A guide uses the scope. Finish or cancel the guide first.";
}

void RecordingPane::toggle_recording(const std::vector<protocol::Signal>& scope_signals) {
  recorder_ ? stop() : start(scope_signals);
}

void RecordingPane::mark(const std::string& text) {
  desk_.mark(text.empty() ? fmt::format("mark {}", ++marks_) : text);  // the recording receives all events
}

void RecordingPane::follow_recording(const std::vector<device::ScopeSamples>& samples) {
  const DeviceView& view = desk_.view();
  for (const auto& each : samples) recorder_->push(each);
  const device::EventLog& events = desk_.events();
  for (next_event_ = std::max(next_event_, events.begin()); next_event_ < events.end(); ++next_event_)
    recorder_->note(events[next_event_]);
  const bool went_away = !view.connected();
  if (!went_away && recorder_->status().running) return;
  if (went_away) recorder_->miss_end();
  stop();
  if (went_away && last_status_->error.empty())
    last_status_->error = "The device was disconnected. The recording contains all samples until the disconnection.";
}

void RecordingPane::follow_replay_wish() {
  if (!replay_wish_ || replay_wish_->asks || force_is_on()) return;
  const auto wish = std::exchange(replay_wish_, std::nullopt);
  try {
    replay_(wish->file);
  } catch (const device::Error& error) {
    replay_error_ = error.what();
  }
}

void RecordingPane::draw(const PaneFrame& frame) {
  const Style& style = frame.style;
  text(style.fonts.strong, style.palette->text, "Record");
  if (recorder_)
    draw_progress(style);
  else
    draw_choice(frame);
  draw_captured(style);
  ImGui::Dummy({0, style.points(10)});
  text(style.fonts.strong, style.palette->text, "Replay");
  draw_replay(style);
}

void RecordingPane::draw_choice(const PaneFrame& frame) {
  const Style& style = frame.style;
  const Palette& palette = *style.palette;
  const std::string waits = why_recording_waits(frame.scope_is_free);
  wrapped_text(palette.text_quiet,
               waits.empty() ? "Records every control period and the parameters as HDF5 (.h5) or CSV." : waits);
  const float button_width = style.points(74);
  ImGui::SetNextItemWidth(ImGui::GetContentRegionAvail().x - button_width - ImGui::GetStyle().ItemSpacing.x);
  need_glyphs(file_);
  ImGui::InputTextWithHint("##file", "default: date and time", &file_);
  note_item("file");
  help_on_hover("File",
                fmt::format("The file extension selects the format: .h5 or .csv. The default folder is {}.",
                            std::filesystem::current_path().string()),
                style);
  ImGui::SameLine();
  if (button("Choose", {button_width, 0})) {
    task_ = FileTask::record;
    chooser_.ask({.title = "Record to a file",
                  .help = "The file extension selects the format: HDF5 (.h5) or CSV (.csv).",
                  .button = "Choose",
                  .endings = {".h5", ".csv"},
                  .is_new_file = true,
                  .suggestion = file_.empty() ? name_from_time() : file_});
  }
  static constexpr const char* choices[] = {"Signals for replay and plots", "Complete signal path",
                                            "Scope signals only"};
  ImGui::SetNextItemWidth(-1);
  int chosen = static_cast<int>(choice_);
  if (ImGui::Combo("##signals", &chosen, choices, 3)) choice_ = static_cast<Choice>(chosen);
  help_on_hover("Signals", "The recording always includes the signals of the scope.", style);
  draw_texts(style);
  ImGui::BeginDisabled(!waits.empty());
  if (record_button(style)) start(frame.scope_signals);
  ImGui::EndDisabled();
  if (!start_error_.empty()) wrapped_text(palette.danger_text, start_error_);
  if (!last_status_) return;
  ImGui::Dummy({0, style.points(4)});
  if (last_status_->error.empty())
    wrapped_text(palette.good, fmt::format("{} is complete.", written_file_));
  else
    wrapped_text(palette.danger_text, last_status_->error);
  draw_numbers(style, *last_status_);
}

void RecordingPane::draw_texts(const Style& style) {
  const auto field = [&](const char* label, const char* item, const char* hint, const char* help, std::string& value) {
    ImGui::SetNextItemWidth(-1);
    need_glyphs(value);
    ImGui::InputTextWithHint(label, hint, &value);
    note_item(item);
    help_on_hover("", help, style);
  };
  field("##name", "name", "name (optional)", "Name of the recording, such as a subject and a trial.", name_);
  field("##note", "note", "note (optional)", "Note that is stored in the recording.", note_);
}

void RecordingPane::draw_progress(const Style& style) {
  const Palette& palette = *style.palette;
  wrapped_text(palette.text_quiet, written_file_);
  draw_numbers(style, recorder_->status());
  if (coloured_button("Stop recording###record", palette.raised_active, palette.text, {-1, style.points(34)}))
    return stop();
  ImGui::Dummy({0, style.points(4)});
  const float button_width = style.points(64);
  ImGui::SetNextItemWidth(ImGui::GetContentRegionAvail().x - button_width - ImGui::GetStyle().ItemSpacing.x);
  need_glyphs(mark_text_);
  const bool entered =
      ImGui::InputTextWithHint("##mark", "text of the mark", &mark_text_, ImGuiInputTextFlags_EnterReturnsTrue);
  note_item("mark text");
  ImGui::SameLine();
  if (button("Mark", {button_width, 0}) || entered) {
    mark(mark_text_);
    mark_text_.clear();
  }
  help_on_hover("Mark",
                "Adds a mark to the recording. Parameter changes, force on/off and faults are marked automatically.",
                style);
}

void RecordingPane::draw_captured(const Style& style) {
  const Palette& palette = *style.palette;
  ImGui::Dummy({0, style.points(2)});
  const bool can_save = !capture_.is_empty() && captured_device_ && !capture_writer_.is_running();
  ImGui::BeginDisabled(!can_save);
  if (button("Save last 60 s", {-1, style.points(30)})) save_captured();
  ImGui::EndDisabled();
  help_on_hover(
      "Save last 60 s",
      "The window always retains the last 60 s. This button saves all signals and events to a new file in the working "
      "folder. Key: Ctrl+S",
      style);
  if (captured_file_.empty()) return;
  if (capture_writer_.is_running())
    wrapped_text(palette.text_quiet, fmt::format("Writing {}.", captured_file_));
  else if (capture_problem_.empty())
    wrapped_text(palette.good, fmt::format("{} is complete.", captured_file_));
  else
    wrapped_text(palette.danger_text, capture_problem_);
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
    replay_wish_ = {file, force_is_on()};
  };
  if (button("Open a recording", {-1, style.points(30)})) {
    task_ = FileTask::replay;
    chooser_.ask(
        {.title = "Replay a recording",
         .help = "Instead of the device, the window then shows the recording with its parameters, signals and marks.",
         .button = "Open",
         .endings = {".h5", ".csv"},
         .suggestion = written_file_});
  }
  const bool has_capture = !captured_file_.empty() && capture_problem_.empty() && !capture_writer_.is_running();
  if (has_capture && button("Replay last minute", {-1, style.points(30)})) replay(captured_file_);
  if (!recorder_ && last_status_ && button("Replay last recording", {-1, style.points(30)})) replay(written_file_);
  draw_question(style);
  if (!replay_error_.empty()) wrapped_text(style.palette->danger_text, replay_error_);
  const auto chosen = chooser_.draw(style);
  if (!chosen) return;
  if (task_ == FileTask::replay) return replay(*chosen);
  file_ = chosen->string();
  may_be_replaced_ = *chosen;  // the file dialog has already asked about an existing file
}

void RecordingPane::draw_question(const Style& style) {
  constexpr const char* question = "force before replay";
  if (!replay_wish_ || !replay_wish_->asks) return;
  if (!ImGui::IsPopupOpen(question)) ImGui::OpenPopup(question);
  ImGui::SetNextWindowPos(ImGui::GetMainViewport()->GetCenter(), ImGuiCond_Always, {0.5f, 0.5f});
  ImGui::SetNextWindowSize({style.points(440), 0});
  if (!ImGui::BeginPopupModal(question, nullptr, ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoMove)) return;
  text(style.fonts.strong, style.palette->text, "The force is on");
  wrapped_text(style.palette->text_quiet, "A replay hides the arm in this window, so the force must be off.");
  const bool agrees = primary_button("Stop and replay", style, {style.points(180), 0});
  ImGui::SameLine();
  const bool cancels = button("Cancel", {style.points(100), 0}) || ImGui::IsKeyPressed(key_index(ImGuiKey_Escape));
  if (agrees) {
    desk_.session().send(protocol::Command::disable_force);
    replay_wish_->asks = false;
  } else if (cancels) {
    replay_wish_.reset();
  }
  if (agrees || cancels) ImGui::CloseCurrentPopup();
  ImGui::EndPopup();
}

}  // namespace

std::unique_ptr<Pane> recording_pane(const PaneSurroundings& around) { return std::make_unique<RecordingPane>(around); }

}  // namespace inkwell::window
