// On a display of 192 dots per inch, window and text have twice the size.
#include <doctest/doctest.h>

#include <string>
#include <utility>
#include <vector>

#include "tests/temporary_directory.hpp"

#include "tests/system/image.hpp"
#include "tests/system/program.hpp"

using namespace inkwell::tests;

TEST_CASE("at 192 dots per inch, or a scale of 2, the window opens twice as big") {
  const TemporaryDirectory directory;
  RunningProgram display({"Xvfb", "-noreset", "-displayfd", "1", "-screen", "0", "2600x1700x24", "-nolisten", "tcp"});
  const std::string name = "DISPLAY=:" + display.read_line();
  const auto size_of_window = [&](std::vector<std::string> options) {
    const auto file = directory.file("window.png");
    std::vector<std::string> words{name,
                                   "LIBGL_ALWAYS_SOFTWARE=1",
                                   build_directory() + "/inkwell",
                                   "--usbip",
                                   "127.0.0.1:9",
                                   "--forget-settings",
                                   "--screenshot",
                                   file,
                                   "--after-seconds",
                                   "0.2"};
    words.insert(words.end(), options.begin(), options.end());
    const auto result = run_program("/usr/bin/env", words);
    INFO(result.err);
    REQUIRE(result.exit_code == 0);
    const auto image = read_png(file);
    return std::pair(static_cast<int>(image.width), static_cast<int>(image.height));
  };
  CHECK(size_of_window({}) == std::pair(1280, 800));
  CHECK(size_of_window({"--scale", "2"}) == std::pair(2560, 1600));
  REQUIRE(run_program("/usr/bin/env", {name, "xprop", "-root", "-f", "RESOURCE_MANAGER", "8s", "-set",
                                       "RESOURCE_MANAGER", "Xft.dpi:\t192"})
              .exit_code == 0);
  CHECK(size_of_window({}) == std::pair(2560, 1600));
  CHECK(size_of_window({"--width", "900", "--height", "560"}) == std::pair(1800, 1120));
}
