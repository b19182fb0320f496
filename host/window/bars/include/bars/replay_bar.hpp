// A recording that is replayed in place of the device, and its bar under the scene: play, pause, where in it, how fast,
// and back to the device.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include <device_desk/parameter_editor.hpp>
#include <frame/file_chooser.hpp>
#include <frame/style.hpp>
#include <recording/overlay.hpp>
#include <recording/replay.hpp>
#include <scope/scope_pane.hpp>

namespace inkwell::window {

inline constexpr float replay_bar_points = 46.0f;

class ReplayBar {
 public:
  /// Opens a recording and plays it. Throws device::Error with a sentence if it cannot be read.
  void open(const std::filesystem::path& file);
  /// Lays another recording over it in the scope, aligned at a mark or, without one, at their begins. Throws likewise.
  void lay_over(const std::filesystem::path& file, const std::string& mark);
  bool is_open() const { return replay_.has_value(); }
  /// Null if none is open.
  const recording::Recording* recording() const { return replay_ ? &replay_->recording() : nullptr; }
  void seek(double position_s) {
    if (replay_) replay_->seek(position_s);
  }
  bool is_playing() const { return replay_ && replay_->is_playing(); }

  /// Once a frame: gives the scope the samples that came by.
  void follow(double now_s, ScopePane& scope);
  std::optional<device::Pose> pose() const { return replay_->pose(); }
  /// Holds the recording's parameters. What is edited in it goes nowhere.
  ParameterEditor& editor() { return editor_; }
  const ParameterEditor& editor() const { return editor_; }

  /// Draws the bar and does what is pressed in it, which may be to close the recording.
  void draw(ImVec2 place, ImVec2 size, const Style& style, ScopePane& scope);

 private:
  void draw_controls(const Style& style);
  void draw_over(const Style& style);
  void align_at(const std::string& mark);
  void draw_track(ImVec2 corner, ImVec2 size, const Style& style);

  std::optional<recording::Replay> replay_;
  std::filesystem::path file_;
  std::string name_;  ///< with folders where the one that is laid over has the same
  std::optional<recording::Overlay> over_;
  std::string aligned_at_;  ///< text of a mark; empty: their begins
  FileChooser chooser_;
  std::string problem_;  ///< of the recording that was to be laid over
  ParameterEditor editor_;
  std::optional<double> followed_until_s_;
};

}  // namespace inkwell::window
