// The real window on a virtual display with a virtual board, operated by mouse and keyboard events. The window reports
// the positions of its items, so that tests do not depend on the layout.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "host/client/device/control_client.hpp"
#include "host/client/device/device.hpp"
#include "host/client/device/virtual_board.hpp"

#include "tests/system/image.hpp"
#include "tests/system/program.hpp"

namespace inkwell::tests {

struct Point {
  double x = 0, y = 0;
};

/// An item of the window, in screen coordinates.
struct Item {
  double x, y, width, height;
  bool enabled;
  Point at(double part_x, double part_y) const { return {x + part_x * width, y + part_y * height}; }
  Point centre() const { return at(0.5, 0.5); }
};

/// Contents of a frame and the corresponding state of the device.
struct Sight {
  nlohmann::json all;

  bool connected() const { return all.at("connected"); }
  std::string state() const { return all.at("state"); }
  /// Returns the control period in which the window's newest transaction became active, or 0 before the first
  /// transaction.
  std::int64_t applied_at_periods() const { return all.value("applied_at_periods", std::int64_t{0}); }
  bool has(const std::string& item) const { return all.at("items").contains(item); }
  /// Throws if the item is not visible. The message lists the visible items.
  Item item(const std::string& name) const;
  bool can_click(const std::string& name) const { return has(name) && item(name).enabled; }
  /// Returns true if the item has the keyboard focus or if the mouse drags the item.
  bool is_active(const std::string& name) const { return has(name) && all.at("items").at(name).at("active"); }
  /// Name of the item with the keyboard focus, such as "status/STOP". Returns an empty name while the mouse is used or
  /// if the item has no name.
  std::string with_keyboard() const;
  /// Returns true if any text in the window contains `part`.
  bool says(const std::string& part) const;
  /// Returns the complete name of an item in the open menu, because ImGui generates the name of a menu. Returns an
  /// empty name without such an item.
  std::string in_menu(const std::string& item) const;
};

class WindowRig {
 public:
  static constexpr const char* usual_screen = "1280x800";

  /// Starts all programs, and waits until the window is connected and its device is referenced. `options` are options
  /// of the window. With --flat-colours the pixels have exactly the colors of palette.hpp. `screen`: size of the
  /// display in pixels. Without the control port, the window handles the virtual board like a real board.
  /// `program` is a program of the build directory with the options of `inkwell`.
  explicit WindowRig(const std::vector<std::string>& options = {"--flat-colours"}, bool tells_control_port = true,
                     const std::string& screen = usual_screen, const std::string& program = "inkwell");

  /// Starts the board `board_name` with the image build/board/`image`, and does not wait for the window.
  static WindowRig with_image(const std::string& image, const std::string& board_name) {
    return WindowRig(OtherImage(), image, board_name);
  }

  /// Returns the first complete frame after all events.
  Sight look();
  /// Waits until a frame satisfies the condition, and throws after a long time limit.
  Sight wait_until(const std::string& what, const std::function<bool(const Sight&)>& condition);
  /// Waits until an item is in the open menu, and clicks the item.
  void click_in_menu(const std::string& item);
  Image picture();
  void picture(const std::string& file);

  /// Sets the window size in pixels.
  void resize(int width, int height);
  void move_to(Point point);
  void press_mouse();
  void release_mouse();
  void click(Point point);
  /// Waits until the item can be clicked.
  void click(const std::string& item);
  /// Moves the mouse in `steps` frames with the button pressed, and does not release the button.
  void drag(Point from, Point to, int steps = 8);
  void scroll_down(Point over, int steps);
  void scroll_up(Point over, int steps);
  void hold_key(const std::string& key);
  void release_key(const std::string& key);
  /// Key in xdotool's notation with modifiers: "ctrl+z".
  void press_key(const std::string& key);
  /// Presses and releases the key within one frame, because a longer press could repeat on a busy machine. Waits for
  /// the frames of a keyboard navigation step.
  void tap_key(const std::string& key);
  void type(const std::string& text);
  /// Sets a keyboard layout by its setxkbmap name, such as "de".
  void set_keyboard_layout(const std::string& layout);
  /// Replaces the content of the text field.
  void enter(const std::string& field, const std::string& text);

  /// Initial parameters of the device.
  static protocol::ParameterSet parameters_at_start();
  void switch_force_on();
  device::Vector3 true_probe_m();
  /// Closes the window and returns the parameters of the device.
  protocol::ParameterSet close_and_read_parameters();
  /// Closes the window and returns the `lines` lines that it printed.
  std::string close_and_read_lines(int lines);
  int window_process() const { return window_.process(); }

  device::VirtualBoard board;
  device::ControlClient control;

 private:
  struct OtherImage {
    explicit OtherImage() = default;
  };
  WindowRig(OtherImage, const std::string& image, const std::string& board_name);

  nlohmann::json ask(const std::string& question);
  void play(const std::vector<std::string>& events);
  void turn_wheel(Point over, int steps, const char* button);

  TemporaryDirectory directory_;
  RunningProgram display_;
  std::string display_name_;
  RunningProgram window_;
};

}  // namespace inkwell::tests
