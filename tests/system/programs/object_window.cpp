// The window with objects that a text file places.
// Usage: object_window --usbip ADDRESS [--control ADDRESS] [--objects FILE] [--ball SUBDIVISIONS] [OPTION...]
// Each line of the file is `object X Y Z ANGLE` or `contact X Y Z`, in meters and radians, or `progress TEXT` or
// `problem TEXT`. The file is read for each frame. Without a file, one object rotates. The other options are options of
// `inkwell`.
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include <glm/gtc/quaternion.hpp>

#include "host/client/device/address.hpp"
#include "host/companion/window/window.hpp"
#include "host/geometry/examples.hpp"

namespace {

using namespace inkwell;

constexpr glm::vec3 axis{0.0f, 1.0f, 0.0f};

struct Placements {
  std::vector<window::ShownObject> objects;
  std::vector<glm::vec3> points_m;
  window::ObjectLoading loading;
};

Placements read_placements(const std::string& path, const std::shared_ptr<const geometry::Mesh>& mesh) {
  Placements placements;
  std::ifstream file(path);
  for (std::string word; file >> word;) {
    if (word == "progress" || word == "problem") {
      std::getline(file >> std::ws, word == "progress" ? placements.loading.progress : placements.loading.problem);
      continue;
    }
    glm::vec3 position_m{0.0f};
    float angle_rad = 0.0f;
    file >> position_m.x >> position_m.y >> position_m.z;
    if (word == "contact") {
      placements.points_m.push_back(position_m);
    } else if (file >> angle_rad) {
      placements.objects.push_back({mesh, position_m, glm::angleAxis(angle_rad, axis)});
    }
  }
  return placements;
}

std::vector<window::ShownObject> rotating_object(const std::shared_ptr<const geometry::Mesh>& mesh) {
  const std::chrono::duration<float> time = std::chrono::steady_clock::now().time_since_epoch();
  return {{mesh, {0.0f, 0.0f, 0.0f}, glm::angleAxis(std::remainder(time.count(), 6.2831853f), axis)}};
}

void set_option(window::WindowOptions& options, const std::string& name, const char* value) {
  if (name == "--usbip") {
    const device::Address board = device::parse_server(value);
    options.list_devices = [board] { return device::find_arms(board); };
    options.board = board;
  }
  if (name == "--control") options.virtual_board_control = device::parse_socket(value);
  if (name == "--parameters") options.parameters_file = value;
  if (name == "--layout") options.layout = value;
  if (name == "--theme") options.theme = std::string(value) == "light" ? window::Theme::light : window::Theme::dark;
  if (name == "--width") options.width = std::atoi(value);
  if (name == "--height") options.height = std::atoi(value);
}

}  // namespace

int main(int count, char** arguments) {
  window::WindowOptions options;
  options.persist_settings = false;
  std::string placements_file;
  geometry::Mesh mesh = geometry::make_box({0.05, 0.05, 0.05});
  for (int i = 1; i < count; ++i) {
    const std::string name = arguments[i];
    if (name == "--inspect") options.inspect = true;
    if (name == "--flat-colours") options.flat_colours = true;
    if (name == "--frames-report") options.frames_report = true;
    if (i + 1 == count) break;
    if (name == "--objects") placements_file = arguments[i + 1];
    if (name == "--ball") mesh = geometry::make_ball(0.04, 0.002, static_cast<unsigned>(std::atoi(arguments[i + 1])));
    if (name == "--example")
      for (const geometry::Example& example : geometry::examples())
        if (example.name == arguments[i + 1]) mesh = example.make();
    set_option(options, name, arguments[i + 1]);
  }
  const auto shared = std::make_shared<const geometry::Mesh>(std::move(mesh));
  if (placements_file.empty()) {
    options.shown_objects = [shared] { return rotating_object(shared); };
  } else {
    options.shown_objects = [=] { return read_placements(placements_file, shared).objects; };
    options.contact_points_m = [=] { return read_placements(placements_file, shared).points_m; };
    options.object_loading = [=] { return read_placements(placements_file, shared).loading; };
  }
  return window::run_window(options);
}
