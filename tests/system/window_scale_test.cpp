// On a display of 192 dots per inch, window and text have twice the size, on X11 and on Wayland.
#include <doctest/doctest.h>

#include <chrono>
#include <filesystem>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "tests/temporary_directory.hpp"

#include "tests/system/image.hpp"
#include "tests/system/program.hpp"

using namespace inkwell::tests;

namespace {

using Size = std::pair<int, int>;

/// Returns the size of a picture of the window in pixels, or nothing if no display was opened. `environment` contains
/// options of `env`.
std::optional<Size> size_of_window(std::vector<std::string> environment, const std::vector<std::string>& options) {
  const TemporaryDirectory directory;
  const auto file = directory.file("window.png");
  auto& words = environment;
  for (const auto& word : {std::string("LIBGL_ALWAYS_SOFTWARE=1"), build_directory() + "/inkwell",
                           std::string("--usbip"), std::string("127.0.0.1:9"), std::string("--forget-settings"),
                           std::string("--screenshot"), file, std::string("--after-seconds"), std::string("0.2")})
    words.push_back(word);
  words.insert(words.end(), options.begin(), options.end());
  const auto result = run_program("/usr/bin/env", words);
  if (result.err.find("No display could be opened") != std::string::npos) return std::nullopt;
  INFO(result.err);
  REQUIRE(result.exit_code == 0);
  const auto image = read_png(file);
  return Size(static_cast<int>(image.width), static_cast<int>(image.height));
}

}  // namespace

TEST_CASE("at 192 dots per inch, or a scale of 2, the window opens twice as big") {
  RunningProgram display({"Xvfb", "-noreset", "-displayfd", "1", "-screen", "0", "2600x1700x24", "-nolisten", "tcp"});
  const std::string name = "DISPLAY=:" + display.read_line();
  const auto size = [&](const std::vector<std::string>& options) { return size_of_window({name}, options); };
  CHECK(size({}) == Size(1280, 800));
  CHECK(size({"--scale", "2"}) == Size(2560, 1600));
  REQUIRE(run_program("/usr/bin/env", {name, "xprop", "-root", "-f", "RESOURCE_MANAGER", "8s", "-set",
                                       "RESOURCE_MANAGER", "Xft.dpi:\t192"})
              .exit_code == 0);
  CHECK(size({}) == Size(2560, 1600));
  CHECK(size({"--width", "900", "--height", "560"}) == Size(1800, 1120));
}

TEST_CASE("on Wayland, the window of a scaled desktop has as many points as without a scale, and twice the pixels") {
  if (!std::filesystem::exists("/usr/bin/weston")) {
    MESSAGE("skipped: weston is not installed");
    return;
  }
  for (const int scale : {1, 2}) {
    CAPTURE(scale);
    const TemporaryDirectory runtime;
    // The X11 back end of weston has a mouse. GLFW fails without a mouse.
    RunningProgram display({"Xvfb", "-noreset", "-displayfd", "1", "-screen", "0", "3840x2160x24", "-nolisten", "tcp"});
    const std::string folder = "XDG_RUNTIME_DIR=" + runtime.path();
    RunningProgram desktop(
        {"weston", "--backend=x11-backend.so", "--socket=desktop", "--scale=" + std::to_string(scale), "--width=1920",
         "--height=1080", "--idle-time=0", "--log=" + runtime.file("log")},
        {"DISPLAY=:" + display.read_line(), folder, "LIBGL_ALWAYS_SOFTWARE=1"});
    const auto deadline = std::chrono::steady_clock::now() + patience;
    while (!std::filesystem::exists(runtime / "desktop") && std::chrono::steady_clock::now() < deadline)
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    const auto size = [&](const std::vector<std::string>& options) {
      return size_of_window({"-u", "DISPLAY", folder, "WAYLAND_DISPLAY=desktop", "INKWELL_WINDOW_SYSTEM=wayland"},
                            options);
    };
    const auto natural = size({});
    if (!natural) {
      MESSAGE("skipped: the GLFW of this computer does not support Wayland");
      return;
    }
    CHECK(*natural == Size(scale * 1280, scale * 800));
    CHECK(size({"--scale", std::to_string(scale)}) == natural);
  }
}
