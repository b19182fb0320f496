// The pane that records: what, where to, start, stop and marks, with progress, size, free space and errors; and that
// opens a recording to be replayed.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <device_desk/device_desk.hpp>
#include <frame/file_chooser.hpp>
#include <frame/style.hpp>
#include <recording/recorder.hpp>

namespace inkwell::window {

class RecordingPane {
 public:
  /// Once a frame, with the scope's frames since the last one, whether the pane is shown or not. Ends the recording
  /// when the device goes away, and marks each change of a parameter in it.
  void follow(const DeviceView& view, const std::vector<device::ScopeSamples>& frames);
  /// `scope_signals`: what the scope shows, which goes on being streamed, and is recorded with the rest.
  void draw(ImVec2 place, ImVec2 size, const Style& style, const DeviceView& view, bool scope_is_free,
            const std::vector<protocol::Signal>& scope_signals);

  bool is_recording() const { return recorder_ != nullptr; }
  /// What has to be streamed while it records.
  const std::vector<protocol::Signal>& signals() const { return signals_; }
  /// The file that the user wants to see replayed, once.
  std::optional<std::filesystem::path> take_replay_wish();
  /// Why that file could not be replayed.
  void refuse_replay(std::string sentence) { replay_error_ = std::move(sentence); }

 private:
  enum class Choice : std::uint8_t { standard, path, scope };

  void start(const DeviceView& view, const std::vector<protocol::Signal>& scope_signals);
  void stop();
  void mark_changes(const protocol::ParameterSet& now);
  void draw_choice(const Style& style, const DeviceView& view, bool scope_is_free,
                   const std::vector<protocol::Signal>& scope_signals);
  void draw_progress(const Style& style);
  void draw_numbers(const Style& style, const recording::RecorderStatus& status);
  void draw_replay(const Style& style);

  std::string file_;  ///< empty: a name made from the time
  Choice choice_ = Choice::standard;
  std::string mark_text_;
  std::unique_ptr<recording::Recorder> recorder_;
  std::vector<protocol::Signal> signals_;
  protocol::ParameterSet parameters_{};  ///< as they were when last looked at
  std::string written_file_;             ///< the recording that runs, or ran last
  std::optional<recording::RecorderStatus> last_status_;
  std::string start_error_;
  enum class FileTask : std::uint8_t { record, replay } task_ = FileTask::replay;
  FileChooser chooser_;
  std::optional<std::filesystem::path> may_be_replaced_;
  std::string replay_error_;
  std::optional<std::filesystem::path> replay_wish_;
};

/// "wall_stiffness_N_per_m = 600", for each parameter that differs.
std::vector<std::string> describe_changes(const protocol::ParameterSet& before, const protocol::ParameterSet& now);

/// How long a recording can go on until its disk is full, in words; empty while that cannot be told.
std::string time_left(const recording::RecorderStatus& status);

}  // namespace inkwell::window
