// The replayed recording, and the bar with the replay controls.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "host/client/recording/overlay.hpp"
#include "host/client/recording/replay.hpp"
#include "host/companion/window/device_desk/parameter_editor.hpp"
#include "host/companion/window/frame/file_chooser.hpp"
#include "host/companion/window/frame/style.hpp"
#include "host/companion/window/scope/scope_pane.hpp"

namespace inkwell::window {

inline constexpr float replay_bar_points = 46.0f;

class ReplayBar {
 public:
  /// Opens a recording and plays it. Throws device::Error if the recording cannot be read.
  void open(const std::filesystem::path& file);
  /// Overlays a second recording in the scope. The recordings are aligned at `mark`, or at their starts if `mark` is
  /// empty. Throws device::Error if the recording cannot be read.
  void lay_over(const std::filesystem::path& file, const std::string& mark);
  bool is_open() const { return replay_.has_value(); }
  /// Returns null if no recording is open.
  const recording::StoredRecording* recording() const { return replay_ ? &replay_->recording() : nullptr; }
  void seek(double position_s) {
    if (replay_) replay_->seek(position_s);
  }
  void toggle_play() {
    if (!replay_) return;
    replay_->is_playing() ? replay_->pause() : replay_->play();
  }
  bool is_playing() const { return replay_ && replay_->is_playing(); }

  /// Call once per frame. Passes the samples since the last call to the scope.
  void follow(double now_s, ScopePane& scope);
  std::optional<device::Pose> pose();
  /// Returns an editor for the recorded parameters. The edits are not sent to any device.
  ParameterEditor& editor() { return editor_; }
  const ParameterEditor& editor() const { return editor_; }

  /// Draws the bar and handles the buttons. The Close button closes the recording.
  void draw(ImVec2 origin, ImVec2 size, const Style& style, ScopePane& scope);

 private:
  /// Reads only the signals that the scope shows. Returns true if the selection has changed.
  bool select_signals(const ScopePane& scope);
  void refill(ScopePane& scope) const;
  std::vector<ReceivedBlock> with_over(std::vector<device::ScopeSamples> blocks) const;
  void stop_at(const device::Error& error);
  void draw_controls(float name_room, const Style& style);
  void draw_over(const Style& style);
  void align_at(const std::string& mark);
  void draw_track(ImVec2 corner, ImVec2 size, const Style& style);

  std::optional<recording::Replay> replay_;
  std::filesystem::path file_;
  std::string name_;  ///< file name, with its folders if both recordings have the same file name
  std::optional<recording::Overlay> over_;
  std::string aligned_at_;  ///< text of the mark that aligns the recordings; empty: aligned at their starts
  FileChooser chooser_;
  std::string problem_;  ///< error of the last overlay or of a damaged file; empty: no error
  ParameterEditor editor_;
  std::optional<double> followed_until_s_;
};

}  // namespace inkwell::window
