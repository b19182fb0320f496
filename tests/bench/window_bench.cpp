// Measures the window's frame rate during motion and its processor load at rest, with software OpenGL and a virtual
// board.
#include <algorithm>
#include <cstdio>
#include <fstream>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include <unistd.h>

#include "tests/system/window_rig.hpp"

namespace {

using namespace inkwell;
using namespace std::chrono_literals;

constexpr auto measured_for = 10s;

/// Returns the processor time of the process and its threads: utime plus stime in /proc/PID/stat.
double processor_time_s(int process) {
  std::ifstream file("/proc/" + std::to_string(process) + "/stat");
  std::string text;
  std::getline(file, text);
  std::istringstream fields(text.substr(text.rfind(')') + 2));
  std::string skipped;
  for (int field = 3; field < 14; ++field) fields >> skipped;
  double user = 0, system = 0;
  fields >> user >> system;
  return (user + system) / static_cast<double>(sysconf(_SC_CLK_TCK));
}

double share_of_a_core(int process) {
  const double before_s = processor_time_s(process);
  std::this_thread::sleep_for(measured_for);
  return (processor_time_s(process) - before_s) / std::chrono::duration<double>(measured_for).count();
}

/// The hand repeatedly pushes the sphere into the right wall and along this wall.
void push_for(device::ControlClient& control, double time_s) {
  const device::Vector3 start_m{0.0, 0.0, -0.03};
  control.hand({.holds = true, .target_m = start_m, .stiffness_N_per_m = 600, .damping_Ns_per_m = 6});
  control.dock(false);
  std::vector<device::HandWaypoint> path{{0.0, start_m}};
  for (int i = 1; 0.3 * i < time_s; ++i)
    path.push_back({0.3 * i, {i % 2 ? 0.09 : 0.05, i % 4 < 2 ? 0.02 : -0.02, -0.03}});
  control.hand_path(path);
}

void measure(const std::string& layout, const std::string& width, const std::string& height,
             const std::string& program = "inkwell", const std::vector<std::string>& more_options = {}) {
  const std::string size = width + "x" + height;
  std::vector<std::string> options{"--layout", layout, "--width", width, "--height", height, "--frames-report"};
  options.insert(options.end(), more_options.begin(), more_options.end());
  tests::WindowRig rig(options, true, size, program);
  std::this_thread::sleep_for(2s);
  std::printf("layout %s at %s\n  at rest: %.0f %% of a core\n", layout.c_str(), size.c_str(),
              100 * share_of_a_core(rig.window_process()));
  rig.switch_force_on();
  push_for(rig.control, 1.5 * std::chrono::duration<double>(measured_for).count());
  const double moving = share_of_a_core(rig.window_process());
  const std::string report = rig.close_and_read_lines(2);
  // A busy machine shows fewer frames, but the processor time per frame is the same.
  std::printf("  moving:  %.0f %% of a core, %.1f ms of it for a frame; %s", 100 * moving,
              1000 * moving / std::stod(report), report.c_str());
  std::fflush(stdout);
}

}  // namespace

/// Measures the layouts in the arguments, or all layouts by default.
int main(int argument_count, char** arguments) {
  const std::vector<std::string> wanted(arguments + 1, arguments + argument_count);
  const auto is_wanted = [&wanted](const std::string& layout) {
    return wanted.empty() || std::ranges::find(wanted, layout) != wanted.end();
  };
  std::printf(
      "Window on software OpenGL, 10 s at rest and 10 s moving, beside the virtual board "
      "(simulation, real time):\n");
  for (const std::string layout : {"contact", "paper"})
    if (is_wanted(layout)) measure(layout, "1280", "800");
  if (is_wanted("overview")) measure("overview", "1920", "1080");  // eight plots
  if (is_wanted("object")) {
    std::printf("a rotating object of 327,680 triangles, also at rest:\n");
    measure("contact", "1280", "800", "object-window", {"--ball", "7"});
  }
}
