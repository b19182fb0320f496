// Interface of a pane of the right column.
#pragma once

// To add a pane:
// 1. Write host/window/panes/NAME_pane.cpp with a class derived from Pane and the function NAME_pane() that creates
//    it. title() is the text of the tab.
// 2. Add the line PANE(NAME_pane) to host/window/panes/registry.cpp.
// 3. Return the displayed signals from shown_signals(). follow() receives their samples together with other
//    signals: find the column in ScopeSamples::signals. Override stream() only if the pane needs the stream
//    exclusively.
// 4. Put code that needs no display into the library inkwell_window_panes_parts, with tests in
//    tests/host/window/panes.
// 5. Add a system test to tests/system and a picture to tests/system/pictures.cpp.

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <device/device.hpp>
#include <device_desk/device_desk.hpp>
#include <device_desk/parameter_editor.hpp>
#include <frame/style.hpp>
#include <panes/pane_stream.hpp>
#include <recording/recording.hpp>

namespace inkwell::window {

/// Constructor argument of a pane. All referenced objects outlive the pane.
struct PaneSurroundings {
  DeviceDesk& desk;
  /// Saved path of the parameter file that was loaded or saved last.
  std::filesystem::path& parameters_file;
  std::filesystem::path parameters_to_send;  ///< sent once a device is connected; empty: none
  /// Control socket of the virtual board, for its simulated hand and for fault injection; empty for a real device.
  std::optional<device::SocketAddress> control;
  /// Arm of the virtual board, if known from a source other than the device.
  std::optional<protocol::ParameterSet> simulated_arm;
  /// Replays a recording instead of the device. Throws device::Error if the recording cannot be read.
  std::function<void(const std::filesystem::path&)> replay;
  bool starts_with_replay = false;
  /// Returns the replayed recording; null if none is open.
  std::function<const recording::Recording*()> replayed;
  /// Moves the replay to a time since the first sample of the recording.
  std::function<void(double)> seek;
};

/// Data that arrived since the last frame.
struct PaneNews {
  ParameterEditor& editor;                           ///< edits the device's parameters
  const std::vector<device::ScopeSamples>& samples;  ///< from the device, also during a replay
  double now_s;
};

/// Data with which a pane is drawn.
struct PaneFrame {
  const Style& style;
  ParameterEditor& editor;  ///< edits the parameters of the device or of the replayed recording
  bool is_replay;
  const std::vector<protocol::Signal>& scope_signals;  ///< displayed in the scope
  double now_s;
  bool scope_is_free = true;  ///< no pane has reserved the scope stream
};

class Pane {
 public:
  Pane() = default;
  virtual ~Pane() = default;
  Pane(const Pane&) = delete;
  Pane& operator=(const Pane&) = delete;

  /// Text of the tab. In lower case the text is the pane's name in inspections.
  virtual std::string_view title() const = 0;
  /// Called when a key selects the pane. Returns true if the pane sets the keyboard focus; otherwise the first control
  /// receives it.
  virtual bool take_keyboard() { return false; }
  /// Called once per frame, whether or not the pane is shown.
  virtual void follow(const PaneNews&) {}
  /// Draws the content while the pane is shown. The pane's ImGui window is open.
  virtual void draw(const PaneFrame& frame) = 0;
  /// Stops all device actions of the pane, on a stop by the user or before a device change.
  virtual void cancel() {}

  /// Streamed in addition to the scope's signals while the pane is shown and no pane reserves the stream. PaneNews
  /// contains the samples.
  virtual std::vector<protocol::Signal> shown_signals() const { return {}; }
  /// Reserves the scope stream, for example during a guide or a recording.
  virtual PaneStream stream() const { return {}; }
  /// Short state text for the tab; empty if the pane is idle.
  virtual std::string running() const { return {}; }
  /// True if values in the pane are not stored. The tab is marked while another pane is shown.
  virtual bool has_values_to_store() const { return false; }
  /// True if the content changes without input.
  virtual bool is_moving() const { return false; }
  /// The first pane that returns true is shown initially. If none does, the first pane is shown.
  virtual bool is_shown_at_start() const { return false; }
};

}  // namespace inkwell::window
