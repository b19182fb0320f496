// A pane of the right column: what it is given, and what it can do.
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

/// What a pane is made with. All of it outlives the pane.
struct PaneSurroundings {
  DeviceDesk& desk;
  /// The parameter file that was loaded or saved last; remembered from one time to the next.
  std::filesystem::path& parameters_file;
  std::filesystem::path parameters_to_send;  ///< once a device is connected; empty: none
  /// Control socket of the virtual board whose simulated hand can do the user's part, and which can be given faults;
  /// none for a real device.
  std::optional<device::SocketAddress> control;
  /// The arm of that board, if it is known otherwise than from the device.
  std::optional<protocol::ParameterSet> simulated_arm;
  /// Replays a recording in place of the device; throws device::Error with a sentence if it cannot be read.
  std::function<void(const std::filesystem::path&)> replay;
  bool starts_with_replay = false;
  /// The recording that is replayed; null if none is.
  std::function<const recording::Recording*()> replayed;
  /// Goes to a time of it since its first sample.
  std::function<void(double)> seek;
};

/// What has come since the last frame.
struct PaneNews {
  ParameterEditor& editor;                           ///< of the device's parameters
  const std::vector<device::ScopeSamples>& samples;  ///< of the device, also while a recording is replayed
  double now_s;
};

/// What a pane needs for drawing itself.
struct PaneFrame {
  const Style& style;
  ParameterEditor& editor;  ///< of the device's parameters, or of those of the recording that is replayed
  bool is_replay;
  const std::vector<protocol::Signal>& scope_signals;  ///< what the scope shows
  double now_s;
  bool scope_is_free = true;  ///< no pane has taken the stream of samples from it
};

class Pane {
 public:
  Pane() = default;
  virtual ~Pane() = default;
  Pane(const Pane&) = delete;
  Pane& operator=(const Pane&) = delete;

  /// Stands on its tab, and names it for inspections in small letters.
  virtual std::string_view title() const = 0;
  /// It has come to be shown by a key. True if it gives the keyboard to something in it; else its first thing gets it.
  virtual bool take_keyboard() { return false; }
  /// Once a frame, whether the pane is shown or not.
  virtual void follow(const PaneNews&) {}
  /// Draws what is in it while it is shown; its ImGui window is open.
  virtual void draw(const PaneFrame& frame) = 0;
  /// What it has the device do ends here: the user stops everything, or goes to another device.
  virtual void cancel() {}

  /// Streamed beside the scope's signals while the pane is shown and no pane takes the stream. Their samples come with
  /// the others in PaneNews.
  virtual std::vector<protocol::Signal> shown_signals() const { return {}; }
  /// For a pane that takes the stream for a while, as a guide or a recording does.
  virtual PaneStream stream() const { return {}; }
  /// What goes on in it, in a few characters that stand on its tab; empty: nothing.
  virtual std::string running() const { return {}; }
  /// Values wait in it to be stored: a mark stands on its tab while another pane is shown.
  virtual bool has_values_to_store() const { return false; }
  /// Its picture changes by itself.
  virtual bool is_moving() const { return false; }
  /// The first pane of which this is true is shown at the start; the first of all if it is true of none.
  virtual bool is_shown_at_start() const { return false; }
};

}  // namespace inkwell::window
