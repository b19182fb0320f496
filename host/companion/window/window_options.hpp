// Options of the window.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "host/client/device/address.hpp"
#include "host/client/device/session.hpp"
#include "host/companion/window/frame/palette.hpp"
#include "host/companion/window/frame/window_size.hpp"
#include "host/companion/window/scene/shown_object.hpp"
#include "protocol/parameters.hpp"

namespace inkwell::window {

/// The window replays this recording after the start.
struct ReplayRequest {
  std::filesystem::path recording;  ///< empty: no replay
  std::filesystem::path over = {};  ///< recording that is overlaid; empty: none
  std::string align = {};           ///< text of the mark that aligns the recordings; empty: aligned at their starts
};

struct WindowOptions {
  /// Lists the available arms. Mandatory. Background threads call this function about once per second while no device
  /// is connected or the device list is open. The window shows the message of a thrown device::Error.
  std::function<std::vector<device::Endpoint>()> list_devices;
  /// The window connects only to the arm with this serial number. If the serial number is empty, the user chooses an
  /// arm.
  std::string serial_number;
  /// Control socket of a virtual board. The window uses the socket for the simulated hand and the stylus buttons.
  std::optional<device::SocketAddress> virtual_board_control;

  /// Starts a virtual board and sets the options for this board. Null if a virtual board is in use or unavailable.
  /// Called in the window's thread; throws device::Error.
  std::function<void(WindowOptions&)> start_virtual_board = {};

  /// Parameters of the simulated arm for the guides. Default: the device's parameters.
  std::optional<protocol::ParameterSet> simulated_arm;

  /// Firmware image for updates; empty if the window offers no updates. `board` is the address of the board. If the
  /// serial number in `board` is empty, the window updates the chosen board.
  std::filesystem::path firmware;
  device::Address board;

  int width = 1280;  ///< in points; a high-resolution display has several pixels per point
  int height = 800;
  std::optional<Theme> theme;    ///< default: the saved theme
  float scale = 0.0f;            ///< scale of fonts, spacing and window; 0 uses the scale of the display
  bool persist_settings = true;  ///< read and write the settings in the user's configuration directory
  /// Disables lighting in the scene, so that solid bodies have exactly the colors of palette.hpp.
  bool flat_colours = false;
  std::string layout;  ///< initial layout of the scope, e.g. "paper"; empty: the saved layout

  ReplayRequest replay;

  /// Returns the objects of the scene. Called in the window's thread for each frame, and up to 60 times per second at
  /// rest, so the function must be fast. Null: no objects.
  std::function<std::vector<ShownObject>()> shown_objects = {};
  /// Returns the points at which the tip touches objects, in workspace axes. Called like `shown_objects`. Null: no
  /// points.
  std::function<std::vector<glm::vec3>()> contact_points_m = {};
  /// Returns the state of the loading of objects. Called like `shown_objects`. Null: nothing is loaded.
  std::function<ObjectLoading()> object_loading = {};
  /// For Session::on_pose() of each device.
  std::function<void(device::Device&, const device::DrivenPose&)> on_pose = {};

  std::filesystem::path screenshot;       ///< if set: write the framebuffer to this PNG file and close
  double after_seconds = 3.0;             ///< time of the screenshot after the first frame
  std::filesystem::path parameters_file;  ///< sent to the first connected device
  bool inspect = false;                   ///< answer requests on standard input, for tests; see inspection.hpp
  bool frames_report = false;             ///< print the measured frame rate on exit
};

}  // namespace inkwell::window
