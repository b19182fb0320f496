// Interface of a pane in the right column.
#pragma once

// To add a pane:
// (1) Write host/companion/window/panes/NAME_pane.cpp. The file defines a class derived from Pane and the function
//     NAME_pane(), which creates the pane. The function title() returns the text of the tab.
// (2) Add the line PANE(NAME_pane) to host/companion/window/panes/registry.cpp.
// (3) Return the displayed signals from shown_signals(). The function follow() receives the samples of all streamed
//     signals, in the order of ScopeSamples::signals. Override stream() only if the pane needs the stream exclusively.
// (4) Put code that needs no display into the library inkwell_window_panes_parts. Put the tests of this code into
// tests/host/companion/window/panes.
// (5) Add a system test to tests/system and a picture to tests/system/pictures.cpp.

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "host/client/device/device.hpp"
#include "host/client/recording/stored_recording.hpp"
#include "host/companion/window/device_desk/device_desk.hpp"
#include "host/companion/window/device_desk/parameter_editor.hpp"
#include "host/companion/window/frame/style.hpp"
#include "host/companion/window/panes/pane_stream.hpp"

namespace inkwell::window {

class PlotSaver;

/// Constructor argument of a pane. All referenced objects outlive the pane.
struct PaneSurroundings {
  DeviceDesk& desk;
  /// Path of the last loaded or saved parameter file. The path is saved in the settings.
  std::filesystem::path& parameters_file;
  std::filesystem::path parameters_to_send;  ///< file that is sent once a device is connected; empty: none
  /// Control socket of the virtual board; empty for a real device.
  std::optional<device::SocketAddress> control;
  /// Parameters of the simulated arm. Default: the device's parameters.
  std::optional<protocol::ParameterSet> simulated_arm;
  /// Starts the replay of a recording. Throws device::Error if the recording cannot be read.
  std::function<void(const std::filesystem::path&)> replay;
  bool starts_with_replay = false;
  /// Returns the replayed recording; null if no recording is open.
  std::function<const recording::StoredRecording*()> replayed;
  /// Moves the replay to a time in seconds after the first sample.
  std::function<void(double)> seek;
};

/// Data that arrived since the last frame.
struct PaneNews {
  ParameterEditor& editor;                           ///< edits the device's parameters
  const std::vector<device::ScopeSamples>& samples;  ///< from the device, also during a replay
  double now_s;
};

/// Data for drawing a pane.
struct PaneFrame {
  const Style& style;
  ParameterEditor& editor;  ///< edits the parameters of the device or of the replayed recording
  bool is_replay;
  const std::vector<protocol::Signal>& scope_signals;  ///< displayed in the scope
  double now_s;
  bool scope_is_free = true;  ///< no pane has reserved the scope stream
};

/// Actions of the keys and of the top bar on recordings.
class RecordingControls {
 public:
  virtual ~RecordingControls() = default;
  /// Returns the reason why no recording can start; empty if a recording can start.
  virtual std::string why_recording_waits(bool scope_is_free) const = 0;
  /// Returns the duration of the running recording, such as "0:12"; empty without a recording.
  virtual std::string recording_clock() const = 0;
  /// Starts or stops a recording. A new recording includes `scope_signals`.
  virtual void toggle_recording(const std::vector<protocol::Signal>& scope_signals) = 0;
  /// Adds a mark with a number to the log, to the running recording and to the captured minute.
  virtual void set_mark() = 0;
  /// Saves the captured minute to a new file.
  virtual void save_captured() = 0;
};

class Pane {
 public:
  Pane() = default;
  virtual ~Pane() = default;
  Pane(const Pane&) = delete;
  Pane& operator=(const Pane&) = delete;

  /// Text of the tab. The lower-case text is the pane's name in inspections.
  virtual std::string_view title() const = 0;
  /// Called when a key selects the pane. If the function returns false, the first control receives the keyboard focus.
  virtual bool take_keyboard() { return false; }
  /// Called once per frame, even while a different pane is shown.
  virtual void follow(const PaneNews&) {}
  /// Draws the content into the current ImGui window. Called while the pane is shown.
  virtual void draw(const PaneFrame& frame) = 0;
  /// Stops all device actions of the pane. Called when the user stops the force or changes the device.
  virtual void cancel() {}

  /// Returns additional signals for the scope stream while the pane is shown. The signals are not streamed if a pane
  /// has reserved the stream. PaneNews contains the samples.
  virtual std::vector<protocol::Signal> shown_signals() const { return {}; }
  /// Returns the signals that the pane always needs in addition to the signals of the scope.
  virtual std::vector<protocol::Signal> background_signals() const { return {}; }
  /// Returns the reason why the force must stay off; empty if the pane permits the force.
  virtual std::string why_force_waits() const { return {}; }
  /// Returns null for all panes except the pane that records.
  virtual RecordingControls* recording_controls() { return nullptr; }
  /// Returns null for a pane without plots.
  virtual PlotSaver* plot_saver() { return nullptr; }
  /// Starts the guide with this name; only the pane of the guides has guides.
  virtual void start_guide(std::string_view) {}
  /// Reserves the scope stream, for example during a guide or a recording.
  virtual PaneStream stream() const { return {}; }
  /// Returns a short state text for the tab; empty if the pane is idle.
  virtual std::string running() const { return {}; }
  /// Returns true if the pane has unstored values. The tab of a hidden pane with unstored values has a mark.
  virtual bool has_values_to_store() const { return false; }
  /// Returns true if the content changes without input.
  virtual bool is_moving() const { return false; }
  /// Returns true if the window should initially show this pane. Default: the first pane.
  virtual bool is_shown_at_start() const { return false; }
};

}  // namespace inkwell::window
