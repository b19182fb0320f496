#include "host/companion/command_line/commands.hpp"

#include <algorithm>
#include <array>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "host/client/command_line/help.hpp"
#include "host/client/installation/installed_paths.hpp"
#include "host/companion/window/scope/scope_layout.hpp"
#include "host/companion/window/window.hpp"

namespace inkwell::command_line {
namespace {

/// The completion generator identifies the window options by the word "Window" in their group name.
constexpr char window_group[] = "Window (without a command, or with replay or feel)";
constexpr std::array<std::string_view, 2> commands_with_window{"replay", "feel"};

/// Returns the names of the built-in layouts in the format of the help text. User-defined layouts are valid but not
/// listed.
std::string layout_choices() {
  std::vector<std::string_view> names;
  for (const window::ScopeLayout& layout : window::built_in_layouts()) names.push_back(layout.name);
  return fmt::format("{{{}}}", fmt::join(names, ","));
}

/// Throws UsageError.
std::optional<device::SocketAddress> control_socket(const std::string& text) {
  if (text.empty()) return std::nullopt;
  try {
    return device::parse_socket(text);
  } catch (const device::BadAddress& error) {
    throw UsageError(fmt::format("--control: {}", error.what()));
  }
}

int open_window(const DeviceOptions& options, window::WindowOptions window_options, const std::string& control,
                const std::string& theme) {
  std::unique_ptr<device::VirtualBoard> board;
  if (!theme.empty()) window_options.theme = theme == "light" ? window::Theme::light : window::Theme::dark;
  window_options.firmware = installation::firmware();
  window_options.board = options.address();
  window_options.serial_number = window_options.board.serial_number;
  window_options.virtual_board_control = control_socket(control);
  if (!window_options.virtual_board_control) window_options.virtual_board_control = window_options.board.control;
  window_options.list_devices = [&options] { return device::find_arms(options.address()); };
  const auto start_virtual_board = [&options, &board](window::WindowOptions& of_window) {
    // The user moves the hand with the mouse, so board time must follow real time.
    board = std::make_unique<device::VirtualBoard>(
        options.virtual_board(device::SimulationMode::fast, BoardPace::real_time));
    of_window.serial_number.clear();
    of_window.virtual_board_control = board->control_socket();
    of_window.board = {.kind = device::Address::Kind::usbip, .server = board->usbip()};
    if (of_window.parameters_file.empty()) of_window.parameters_file = options.arm;
    of_window.simulated_arm = protocol::default_parameters();
    if (!options.arm.empty())
      for (const auto& [parameter, value] : device::arm_parameters(options.arm))
        (*of_window.simulated_arm)[parameter] = value;
    of_window.list_devices = [virtual_board = board.get()] {
      const auto endpoint = virtual_board->find();
      return endpoint ? std::vector{*endpoint} : std::vector<device::Endpoint>{};
    };
    of_window.start_virtual_board = nullptr;
  };
  if (options.is_virtual)
    start_virtual_board(window_options);
  else
    window_options.start_virtual_board = start_virtual_board;
  return window::run_window(window_options);
}

void add_size_options(CLI::App& program, window::WindowOptions& window) {
  program
      .add_option("--scale", window.scale,
                  "Scale of fonts, spacing and window, 0.5 to 4. Default: the scale of the display")
      ->type_name("FACTOR")
      ->check(number_within(0.5, 4.0))
      ->group(window_group);
  program
      .add_option("--width", window.width,
                  "Window width in points; a point is one pixel, or several on a high-resolution display")
      ->type_name("POINTS")
      ->check(whole_number_within(window::smallest_window_points.width, 16384))
      ->capture_default_str()
      ->group(window_group);
  program.add_option("--height", window.height, "Height of the window in points")
      ->type_name("POINTS")
      ->check(whole_number_within(window::smallest_window_points.height, 16384))
      ->capture_default_str()
      ->group(window_group);
}

}  // namespace

OpenWindow add_window_options(CLI::App& program, const DeviceOptions& options, Action& action) {
  struct Settings {
    window::WindowOptions window;
    std::string control;
    std::string theme;
    bool forget = false;
  };
  const auto settings = std::make_shared<Settings>();
  auto& window = settings->window;
  const char* group = window_group;
  program
      .add_option("--parameters", window.parameters_file,
                  "TOML file of parameters to send when the device is connected")
      ->type_name("FILE")
      ->group(group);
  program.add_option("--layout", window.layout, "Initial layout of the scope: one of these, or a custom layout")
      ->type_name(layout_choices())
      ->group(group);
  program.add_option("--theme", settings->theme, "Color theme")->check(CLI::IsMember({"dark", "light"}))->group(group);
  add_size_options(program, window);
  program
      .add_option("--screenshot", window.screenshot,
                  "Save a screenshot of the window to this PNG file and close the window")
      ->type_name("FILE")
      ->group(group);
  program.add_option("--after-seconds", window.after_seconds, "Delay of the screenshot after the first frame")
      ->type_name("SECONDS")
      ->check(zero_or_more())
      ->capture_default_str()
      ->group(group);
  program.add_flag("--frames-report", window.frames_report, "Print the frame rate when the window closes")
      ->group(group);
  program
      .add_flag("--inspect", window.inspect,
                "For tests: answer `look`, `picture FILE` and `close` on standard input with JSON lines")
      ->group(group);
  program.add_flag("--flat-colours", window.flat_colours, "Draw the scene without lighting")->group(group);
  program.add_flag("--forget-settings", settings->forget, "Neither read nor write the window's settings")->group(group);
  program
      .add_option("--control", settings->control,
                  "Control socket of the --usbip virtual board for mouse and faults: HOST:PORT or unix:PATH")
      ->type_name("ADDRESS")
      ->group(group);
  const OpenWindow open = [&options, settings](const std::function<void(window::WindowOptions&)>& adapt) {
    adapt(settings->window);
    settings->window.persist_settings = !settings->forget;
    return open_window(options, settings->window, settings->control, settings->theme);
  };
  action = [open] { return open([](window::WindowOptions&) {}); };
  return open;
}

void refuse_window_options_in_vain(const CLI::App& program) {
  const auto commands = program.get_subcommands();
  if (commands.empty() || std::ranges::count(commands_with_window, commands.front()->get_name()) > 0) return;
  for (const CLI::Option* option : program.get_options())
    if (option->get_group() == window_group && option->count() > 0)
      throw UsageError(fmt::format(
          "{} is a window option, and `inkwell {}` opens no window. Omit it, or use it with `inkwell` "
          "alone, `inkwell {}`.",
          option->get_name(), commands.front()->get_name(), fmt::join(commands_with_window, "` or `inkwell ")));
}

}  // namespace inkwell::command_line
