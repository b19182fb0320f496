// Measures the window's frame rate during motion and its processor load at rest, with software OpenGL and a virtual
// board.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include <unistd.h>

#include "host/geometry/examples.hpp"

#include "tests/system/window_rig.hpp"

namespace {

using namespace inkwell;
using namespace std::chrono_literals;

constexpr auto measured_for = 10s;
constexpr double ball_radius_m = 0.025;

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

/// Leads the hand from the inkwell to the start of a path. A path that starts too early raises the fault over_speed.
void follow(tests::WindowRig& rig, std::vector<device::HandWaypoint> path) {
  const device::Vector3 inkwell_m = rig.true_probe_m();
  rig.control.hand({.holds = true, .target_m = inkwell_m, .stiffness_N_per_m = 600, .damping_Ns_per_m = 6});
  rig.control.dock(false);
  path.insert(path.begin(), {0.0, inkwell_m});
  rig.control.hand_path(path);
}

/// The hand repeatedly pushes the sphere into the right wall and along this wall.
void push_for(tests::WindowRig& rig, double time_s) {
  std::vector<device::HandWaypoint> path;
  for (int i = 0; 0.3 * i < time_s; ++i)
    path.push_back({1.5 + 0.3 * i, {i % 2 ? 0.09 : 0.05, i % 4 < 2 ? 0.02 : -0.02, -0.03}});
  follow(rig, path);
}

/// The hand repeatedly slides over a ball in the middle of the workspace, 1 mm deep.
void slide_for(tests::WindowRig& rig, double time_s) {
  const protocol::ParameterSet parameters = tests::WindowRig::parameters_at_start();
  const auto middle_m = [&](protocol::Parameter minimum, protocol::Parameter maximum) {
    return 0.5 * (static_cast<double>(parameters[minimum]) + static_cast<double>(parameters[maximum]));
  };
  const double x_m = middle_m(protocol::Parameter::box_minimum_x_m, protocol::Parameter::box_maximum_x_m);
  const double y_m = middle_m(protocol::Parameter::box_minimum_y_m, protocol::Parameter::box_maximum_y_m);
  const double z_m = middle_m(protocol::Parameter::box_minimum_z_m, protocol::Parameter::box_maximum_z_m);
  const double touch_m = ball_radius_m + static_cast<double>(parameters[protocol::Parameter::sphere_radius_m]);
  std::vector<device::HandWaypoint> path{{1.0, {x_m, y_m, z_m + touch_m + 0.01}}};
  for (double path_s = 1.5; path_s < time_s; path_s += 0.02) {
    const double angle_rad = 0.6 * std::sin(2 * (path_s - 1.5)), distance_m = touch_m - 0.001;
    path.push_back({path_s, {x_m + distance_m * std::sin(angle_rad), y_m, z_m + distance_m * std::cos(angle_rad)}});
  }
  follow(rig, path);
}

/// Writes a ball of 327,680 triangles to a binary STL file in millimeters.
void write_ball(const std::filesystem::path& path) {
  const geometry::Mesh ball = geometry::make_ball(ball_radius_m, 0, 7);
  std::ofstream file(path, std::ios::binary);
  const auto write = [&](const auto& value) { file.write(reinterpret_cast<const char*>(&value), sizeof value); };
  write(std::array<char, 80>{});
  write(static_cast<std::uint32_t>(ball.faces.size()));
  for (const geometry::Face& face : ball.faces) {
    write(glm::vec3{0.0f});
    for (const std::uint32_t vertex : face) write(1000.0f * ball.vertices_m[vertex]);
    write(std::uint16_t{0});
  }
}

void measure(const std::string& layout, const std::string& width, const std::string& height,
             const std::vector<std::string>& more_options = {},
             void (&move_for)(tests::WindowRig& rig, double time_s) = push_for) {
  const std::string size = width + "x" + height;
  std::vector<std::string> options{"--layout", layout, "--width", width, "--height", height, "--frames-report"};
  options.insert(options.end(), more_options.begin(), more_options.end());
  tests::WindowRig rig(options, true, size);
  std::this_thread::sleep_for(2s);
  std::printf("layout %s at %s\n  at rest: %.0f %% of a core\n", layout.c_str(), size.c_str(),
              100 * share_of_a_core(rig.window_process()));
  rig.switch_force_on();
  const nlohmann::json before = rig.look().all;
  move_for(rig, 1.5 * std::chrono::duration<double>(measured_for).count());
  std::this_thread::sleep_for(1500ms);
  const double moving = share_of_a_core(rig.window_process());
  const tests::Sight sight = rig.look();
  if (sight.state() != "active") throw std::runtime_error("the force is off: " + sight.state());
  const auto increase = [&](const char* counter) {
    return sight.all.at(counter).get<std::int64_t>() - before.at(counter).get<std::int64_t>();
  };
  const std::string report = rig.close_and_read_lines(2);
  // A busy machine shows fewer frames, but the processor time per frame is the same.
  std::printf("  moving:  %.0f %% of a core, %.1f ms of it for a frame; %s", 100 * moving,
              1000 * moving / std::stod(report), report.c_str());
  const auto overruns = device::Device::open(*rig.board.find())->information().report.servo_overruns;
  // A busy machine simulates the board more slowly, so there are fewer poses.
  constexpr std::int64_t pose_periods = protocol::servo_rate_Hz / 1000;
  std::printf("  lost:    %lld of %lld poses, and %u control interrupts since the start of the board\n",
              static_cast<long long>(increase("poses_lost")),
              static_cast<long long>(increase("arrived_at_periods") / pose_periods), static_cast<unsigned>(overruns));
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
    std::printf("a ball of 327,680 triangles, which the hand touches:\n");
    const tests::TemporaryDirectory directory;
    write_ball(directory.file("ball.stl"));
    measure("contact", "1280", "800", {"feel", directory.file("ball.stl"), "--unit", "mm"}, slide_for);
  }
}
