// What a caller may ask of the window.
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

/// What is replayed from the start, in place of the device.
struct ReplayRequest {
  std::filesystem::path recording;  ///< empty: nothing is
  std::filesystem::path over = {};  ///< a recording that is laid over it; empty: none
  std::string align = {};           ///< text of the mark at which they are aligned; empty: at their begins
};

struct WindowOptions {
  /// Lists the arms that could be opened now. Called from other threads than the window's, about once a
  /// second while nothing is connected or the device list is open; may throw device::Error, whose sentence
  /// is shown. Must be given.
  std::function<std::vector<device::Endpoint>()> list_devices;
  /// Connect only to this arm; empty takes the first in the list.
  std::string serial_number;
  /// Control socket of a virtual board, through which the mouse moves the simulated hand and the keyboard presses the
  /// stylus' buttons.
  std::optional<device::SocketAddress> virtual_board_control;

  /// Starts a virtual board and changes these options to it; null if there is one, or none can be had. Called from the
  /// window's own thread; throws device::Error with a sentence.
  std::function<void(WindowOptions&)> start_virtual_board = {};

  /// The arm that this virtual board simulates, for the simulated hand of the guides; without it, the arm that the
  /// device's parameters describe.
  std::optional<protocol::ParameterSet> simulated_arm;

  /// The image that boards with another firmware are offered, and the board that it would be written to: with an empty
  /// serial number the one that is chosen. Empty: nothing is offered.
  std::filesystem::path firmware;
  device::Address board;

  int width = 1280;  ///< in points: pixels, or several of them on a fine display
  int height = 800;
  std::optional<Theme> theme;    ///< without it, the one of the last time
  float scale = 0.0f;            ///< of fonts, spacing and the window; 0 asks the display
  bool persist_settings = true;  ///< read and write the settings in the user's configuration directory
  /// Draws the scene without lighting, so that every solid pixel has exactly its colour of palette.hpp.
  bool flat_colours = false;
  std::string layout;  ///< layout of the scope to start with, e.g. "paper"; empty: that of the last time

  ReplayRequest replay;

  std::filesystem::path screenshot;       ///< with it: write the framebuffer to this PNG and close
  double after_seconds = 3.0;             ///< when the screenshot is taken, from the first frame on
  std::filesystem::path parameters_file;  ///< sent to the device as soon as one is connected
  bool inspect = false;                   ///< answer questions on standard input, for tests; see inspection.hpp
  bool frames_report = false;             ///< print the measured frames per second when closing
};

}  // namespace inkwell::window
