#include "tests/system/window_rig.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <thread>

#include <fmt/format.h>

#include "host/client/device/parameter_file.hpp"

namespace inkwell::tests {
namespace {

using namespace std::chrono_literals;
using nlohmann::json;

device::VirtualBoardOptions board_options(const std::filesystem::path& elf = {}, const std::string& board_name = {}) {
  device::VirtualBoardOptions options;
  options.elf = elf;
  options.board = board_name;
  options.mode = device::SimulationMode::fast;
  options.real_time = true;  // the mouse moves the hand, so board time must be real time
  return options;
}

std::vector<std::string> window_words(const device::VirtualBoard& board, const std::string& parameters_file,
                                      const std::vector<std::string>& options, bool tells_control_port,
                                      const std::string& program = "inkwell") {
  device::save_parameters(parameters_file, WindowRig::parameters_at_start());
  std::vector<std::string> words{build_directory() + "/" + program,
                                 "--usbip",
                                 board.usbip().text(),
                                 "--parameters",
                                 parameters_file,
                                 "--forget-settings",
                                 "--inspect"};
  if (tells_control_port) words.insert(words.end(), {"--control", board.control_socket().text()});
  words.insert(words.end(), options.begin(), options.end());
  return words;
}

// The display prints its number when it is ready. Messages about used display numbers are not errors. Key repeat is off
// (-r), because a busy computer may delay the release of a key.
std::vector<std::string> display_command(const std::string& screen) {
  return {"sh", "-c", "exec Xvfb -r -displayfd 1 -screen 0 " + screen + "x24 -nolisten tcp 2>/dev/null"};
}

}  // namespace

Item Sight::item(const std::string& name) const {
  if (!has(name)) throw std::runtime_error(fmt::format("{} cannot be seen in {}", name, all.dump()));
  const json& rectangle = all["items"][name];
  return {rectangle["x"], rectangle["y"], rectangle["width"], rectangle["height"], rectangle["enabled"]};
}

std::string Sight::with_keyboard() const {
  for (const auto& [name, item] : all.at("items").items())
    if (item.at("keyboard")) return name;
  return {};
}

bool Sight::says(const std::string& part) const {
  return std::ranges::any_of(all.at("texts"),
                             [&](const json& text) { return text.get<std::string>().find(part) != std::string::npos; });
}

WindowRig::WindowRig(OtherImage, const std::string& image, const std::string& board_name)
    : board(board_options(build_directory() + "/../board/" + image, board_name)),
      control(board.control()),
      display_(display_command(usual_screen)),
      display_name_("DISPLAY=:" + display_.read_line()),
      window_(window_words(board, directory_.file("parameters.toml"), {}, true),
              {display_name_, "LIBGL_ALWAYS_SOFTWARE=1"}) {}

WindowRig::WindowRig(const std::vector<std::string>& options, bool tells_control_port, const std::string& screen,
                     const std::string& program)
    : board(board_options()),
      control(board.control()),
      display_(display_command(screen)),
      display_name_("DISPLAY=:" + display_.read_line()),
      window_(window_words(board, directory_.file("parameters.toml"), options, tells_control_port, program),
              {display_name_, "LIBGL_ALWAYS_SOFTWARE=1"}) {
  wait_until("the device is ready and has the parameters",
             [](const Sight& sight) { return sight.state() == "ready" && sight.applied_at_periods() != 0; });
}

protocol::ParameterSet WindowRig::parameters_at_start() {
  auto set = protocol::default_parameters();
  set[protocol::Parameter::host_timeout_s] = 2.0f;  // the tests decide when the host is silent, not a busy machine
  return set;
}

json WindowRig::ask(const std::string& question) {
  window_.write_line(question);
  std::string line = window_.read_line();
  while (!line.starts_with('{')) line = window_.read_line();  // a command may print text
  const json answer = json::parse(line);
  if (answer.contains("error")) throw std::runtime_error(answer["error"].get<std::string>());
  return answer;
}

Sight WindowRig::look() { return {ask("look")}; }

Sight WindowRig::wait_until(const std::string& what, const std::function<bool(const Sight&)>& condition) {
  const auto deadline = std::chrono::steady_clock::now() + patience;
  for (;;) {
    Sight sight = look();
    if (condition(sight)) return sight;
    if (std::chrono::steady_clock::now() > deadline)
      throw std::runtime_error(fmt::format("It did not come to this: {}. The window is {} and says {}", what,
                                           sight.state(), sight.all["texts"].dump()));
    std::this_thread::sleep_for(20ms);
  }
}

void WindowRig::picture(const std::string& file) { ask("picture " + file); }

Image WindowRig::picture() {
  const std::string file = directory_.file("picture.png");
  picture(file);
  return read_png(file);
}

// A frame follows each event, because a press and a release in the same frame would cancel each other.
void WindowRig::play(const std::vector<std::string>& events) {
  std::vector<std::string> words{display_name_, "xdotool"};
  words.insert(words.end(), events.begin(), events.end());
  const auto result = run_program("/usr/bin/env", words);
  if (result.exit_code != 0) throw std::runtime_error("xdotool: " + result.err);
  look();
}

void WindowRig::resize(int width, int height) {
  play({"search", "--class", "inkwell", "windowsize", "--sync", "%@", std::to_string(width), std::to_string(height)});
}

void WindowRig::move_to(Point point) {
  play({"mousemove", std::to_string(std::lround(point.x)), std::to_string(std::lround(point.y))});
}
void WindowRig::press_mouse() { play({"mousedown", "1"}); }
void WindowRig::release_mouse() { play({"mouseup", "1"}); }

void WindowRig::click(Point point) {
  move_to(point);
  press_mouse();
  release_mouse();
}

void WindowRig::click(const std::string& item) {
  const auto sight = wait_until(item + " can be clicked", [&](const Sight& now) { return now.can_click(item); });
  click(sight.item(item).centre());
}

void WindowRig::drag(Point from, Point to, int steps) {
  move_to(from);
  press_mouse();
  for (int step = 1; step <= steps; ++step) {
    const double part = static_cast<double>(step) / steps;
    move_to({std::lerp(from.x, to.x, part), std::lerp(from.y, to.y, part)});
  }
}

void WindowRig::turn_wheel(Point over, int steps, const char* button) {
  move_to(over);
  for (int step = 0; step < steps; ++step) play({"click", button});
}
void WindowRig::scroll_down(Point over, int steps) { turn_wheel(over, steps, "5"); }
void WindowRig::scroll_up(Point over, int steps) { turn_wheel(over, steps, "4"); }

void WindowRig::hold_key(const std::string& key) { play({"keydown", key}); }
void WindowRig::release_key(const std::string& key) { play({"keyup", key}); }

void WindowRig::press_key(const std::string& key) {
  hold_key(key);
  release_key(key);
}

void WindowRig::tap_key(const std::string& key) {
  constexpr int further_frames = 4;
  play({"key", "--delay", "0", key});
  for (int frame = 0; frame < further_frames; ++frame) look();
}

void WindowRig::enter(const std::string& field, const std::string& text) {
  click(field);
  press_key("ctrl+a");
  type(text);
}

void WindowRig::type(const std::string& text) {
  play({"type", "--delay", "30", "--", text});
  // ImGui 1.90 accepts one character per frame.
  for (std::size_t frame = 0; frame < text.size(); ++frame) look();
}

void WindowRig::set_keyboard_layout(const std::string& layout) {
  const auto result = run_program("/usr/bin/env", {display_name_, "setxkbmap", layout});
  if (result.exit_code != 0) throw std::runtime_error("setxkbmap: " + result.err);
}

std::string Sight::in_menu(const std::string& item) const {
  for (const auto& each : all.at("items").items())
    if (each.key().starts_with("##Popup") && each.key().ends_with("/" + item)) return each.key();
  return {};
}

void WindowRig::click_in_menu(const std::string& item) {
  const auto sight = wait_until(item + " is in the menu", [&](const Sight& now) { return !now.in_menu(item).empty(); });
  click(sight.in_menu(item));
}

void WindowRig::switch_force_on() {
  click("status/Switch force on");
  wait_until("the force is on", [](const Sight& sight) { return sight.state() == "active"; });
}

device::Vector3 WindowRig::true_probe_m() {
  const auto truth = control.truth();
  return {truth.at("true_position_x_m"), truth.at("true_position_y_m"), truth.at("true_position_z_m")};
}

std::string WindowRig::close_and_read_lines(int lines) {
  ask("close");
  std::string text;
  for (int line = 0; line < lines; ++line) text += window_.read_line() + "\n";
  return text;
}

protocol::ParameterSet WindowRig::close_and_read_parameters() {
  ask("close");
  if (window_.wait(patience) != 0) throw std::runtime_error("the window did not close well");
  const auto endpoint = board.find();
  if (!endpoint) throw std::runtime_error("the device is gone");
  return device::Device::open(*endpoint)->parameters();
}

}  // namespace inkwell::tests
