// Options of the window.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <device/address.hpp>
#include <frame/palette.hpp>
#include <frame/window_size.hpp>
#include <protocol/parameters.hpp>

namespace inkwell::window {

/// Recording that is replayed instead of the device from the start.
struct ReplayRequest {
  std::filesystem::path recording;  ///< empty: no replay
  std::filesystem::path over = {};  ///< recording that is overlaid; empty: none
  std::string align = {};           ///< text of the mark at which both are aligned; empty: at their starts
};

struct WindowOptions {
  /// Lists the arms that can be opened now. Mandatory. Called from other threads about once per second while no device
  /// is connected or the device list is open. The function may throw device::Error, whose message is shown.
  std::function<std::vector<device::Endpoint>()> list_devices;
  /// Connects only to the arm with this serial number. If the serial number is empty and several arms are found, the
  /// user has to choose an arm.
  std::string serial_number;
  /// Control socket of a virtual board. Through it the mouse moves the simulated hand and the keyboard presses the
  /// stylus buttons.
  std::optional<device::SocketAddress> virtual_board_control;

  /// Starts a virtual board and adapts these options to it. Null if a virtual board is already used or not available.
  /// Called in the window's thread; throws device::Error.
  std::function<void(WindowOptions&)> start_virtual_board = {};

  /// Arm that the virtual board simulates, for the simulated hand of the guides. Default: the arm that the device's
  /// parameters describe.
  std::optional<protocol::ParameterSet> simulated_arm;

  /// Image that is offered to boards with another firmware; empty: none. `board` is the board to write to. An empty
  /// serial number selects the chosen board.
  std::filesystem::path firmware;
  device::Address board;

  int width = 1280;  ///< in points: one pixel, or several on a high-resolution display
  int height = 800;
  std::optional<Theme> theme;    ///< default: the saved theme
  float scale = 0.0f;            ///< scale of fonts, spacing and window; 0 uses the scale of the display
  bool persist_settings = true;  ///< read and write the settings in the user's configuration directory
  /// Draws the scene without lighting, so that each solid pixel has exactly its color of palette.hpp.
  bool flat_colours = false;
  std::string layout;  ///< initial layout of the scope, e.g. "paper"; empty: the saved layout

  ReplayRequest replay;

  std::filesystem::path screenshot;       ///< if set: write the framebuffer to this PNG file and close
  double after_seconds = 3.0;             ///< time of the screenshot after the first frame
  std::filesystem::path parameters_file;  ///< sent to the first device that is connected
  bool inspect = false;                   ///< answer requests on standard input, for tests; see inspection.hpp
  bool frames_report = false;             ///< print the measured frame rate on exit
};

}  // namespace inkwell::window
