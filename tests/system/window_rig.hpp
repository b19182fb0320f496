// The real window on a virtual display, with a virtual board, played by input events as a user's mouse and
// keyboard make them. Where to click is asked of the window, so that a new layout breaks no test.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include <device/control_client.hpp>
#include <device/device.hpp>
#include <device/virtual_board.hpp>

#include "image.hpp"
#include "program.hpp"

namespace inkwell::tests {

struct Point {
  double x = 0, y = 0;
};

/// A part of the window, on the screen.
struct Item {
  double x, y, width, height;
  bool enabled;
  Point at(double part_x, double part_y) const { return {x + part_x * width, y + part_y * height}; }
  Point centre() const { return at(0.5, 0.5); }
};

/// What one frame shows, with what the window knew of the device then.
struct Sight {
  nlohmann::json all;

  bool connected() const { return all.at("connected"); }
  std::string state() const { return all.at("state"); }
  /// The control period at which the window's newest transaction took effect; 0 before the first.
  std::int64_t applied_at_periods() const { return all.value("applied_at_periods", std::int64_t{0}); }
  bool has(const std::string& item) const { return all.at("items").contains(item); }
  /// Throws if it cannot be seen, with what can.
  Item item(const std::string& name) const;
  bool can_click(const std::string& name) const { return has(name) && item(name).enabled; }
  /// Whether it has the keyboard, or the mouse holds it.
  bool is_active(const std::string& name) const { return has(name) && all.at("items").at(name).at("active"); }
  /// The thing that has the keyboard, such as "status/STOP"; empty while the mouse is used, or for one without a name.
  std::string with_keyboard() const;
  /// Whether a text that contains this stands anywhere in the window.
  bool says(const std::string& part) const;
};

class WindowRig {
 public:
  static constexpr const char* usual_screen = "1280x800";

  /// Starts everything and waits until the window is connected and its device knows where it is. `options`:
  /// of the window; with flat colours a picture's pixels have exactly the colours of palette.hpp.
  /// `screen`: of the display, in pixels. Without the control port the window knows no more of the virtual board than
  /// of a real one.
  explicit WindowRig(const std::vector<std::string>& options = {"--flat-colours"}, bool tells_control_port = true,
                     const std::string& screen = usual_screen);

  /// The same on a board of this name with another image, build/board/`image`; waits for nothing.
  static WindowRig with_image(const std::string& image, const std::string& board_name) {
    return WindowRig(OtherImage(), image, board_name);
  }

  /// A frame that began after all events so far.
  Sight look();
  /// Looks until the condition is met; throws after a time that no healthy run takes.
  Sight look_until(const std::string& what, const std::function<bool(const Sight&)>& condition);
  Image picture();
  void picture(const std::string& file);

  /// Of the window, in pixels.
  void resize(int width, int height);
  void move_to(Point point);
  void press_mouse();
  void release_mouse();
  void click(Point point);
  /// Waits until it can be clicked.
  void click(const std::string& item);
  /// Moves with the button down in `steps`, each in a frame of its own, and leaves it down.
  void drag(Point from, Point to, int steps = 8);
  void scroll_down(Point over, int steps);
  void scroll_up(Point over, int steps);
  void hold_key(const std::string& key);
  void release_key(const std::string& key);
  /// As xdotool names it, with others that are held: "ctrl+z".
  void press_key(const std::string& key);
  /// The same, down and up at once: on a busy machine the frame between them would last so long that it repeats. Waits
  /// for the frames that a step of the keyboard takes, the search for another thing included.
  void tap_key(const std::string& key);
  void type(const std::string& text);
  /// As setxkbmap names it: "de".
  void set_keyboard_layout(const std::string& layout);
  /// Takes the place of what the text field held.
  void enter(const std::string& field, const std::string& text);

  /// The parameters that the device holds unless a test changes them.
  static protocol::ParameterSet parameters_at_start();
  void switch_force_on();
  device::Vector3 true_probe_m();
  /// Closes the window and returns what the device holds then.
  protocol::ParameterSet close_and_read_parameters();
  /// Closes the window and returns the lines that it printed, of which there are so many.
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
