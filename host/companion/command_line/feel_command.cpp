#include "host/companion/command_line/commands.hpp"

#include <chrono>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "host/client/command_line/help.hpp"
#include "host/client/command_line/interrupt.hpp"
#include "host/client/device/thread_precedence.hpp"
#include "host/client/local/output.hpp"
#include "host/contact/publication.hpp"
#include "host/feel/loading.hpp"
#include "host/feel/materials.hpp"
#include "host/feel/servo.hpp"
#include "host/geometry/examples.hpp"

#include "host/companion/command_line/arm_workspace.hpp"
#include "host/companion/command_line/awaited_object.hpp"
#include "host/companion/command_line/force_switch.hpp"
#include "host/companion/command_line/next_pose.hpp"
#include "host/companion/command_line/progress_bar.hpp"

namespace inkwell::command_line {
namespace {

using device::Pose;

struct FeelOptions {
  std::string file;
  std::string example;
  std::string unit;
  double scale = 1;
  std::string material = "wood";
  bool is_fit = false;
  bool is_smooth = false;
  bool is_headless = false;
  double seconds = 0;  ///< 0: until Ctrl-C
};

constexpr std::uint32_t object_id = 1;

feel::LoadRequest request_of(const DeviceOptions& device_options, const FeelOptions& options) {
  feel::LoadRequest request{.file = options.file,
                            .example = options.example,
                            .scale = options.scale,
                            .is_fit = options.is_fit,
                            .workspace = arm_workspace(device_options)};
  if (!options.unit.empty()) request.unit = importer::parse_unit(options.unit);
  return request;
}

/// A small object needs no progress.
constexpr std::chrono::milliseconds silent_time{300};

feel::LoadedObject load(feel::Loading& loading) {
  using namespace std::chrono_literals;
  const InterruptGuard interrupt;
  ProgressBar bar;
  for (auto wait = silent_time; !loading.is_done_within(wait); wait = 100ms) {
    bar(loading.step(), loading.progress());
    if (interrupt.is_interrupted()) loading.cancel();
  }
  bar.end();
  try {
    return loading.take();
  } catch (const importer::Error& error) {
    throw device::Error(error.what());
  }
}

std::shared_ptr<const contact::Scene> scene_of(const feel::LoadedObject& loaded, const FeelOptions& options) {
  auto scene = std::make_shared<contact::Scene>();
  scene->objects.push_back({.id = object_id, .shape = loaded.surface, .placement = loaded.placement});
  scene->objects.front().is_smooth = options.is_smooth;
  scene->materials[0] = feel::find_material(options.material)->properties;
  return scene;
}

void describe(const feel::LoadedObject& loaded, const FeelOptions& options) {
  const geometry::Measurements& measured = loaded.measurements;
  const glm::dvec3 size_m = glm::dvec3(measured.box.maximum_m) - glm::dvec3(measured.box.minimum_m);
  fmt::print("object              {}, {} triangles, {}\n", loaded.name, measured.triangles,
             measured.is_closed() ? "closed" : "open");
  fmt::print("size                {} x {} x {}\n", importer::length_text(size_m.x), importer::length_text(size_m.y),
             importer::length_text(size_m.z));
  if (!loaded.unit_text.empty()) fmt::print("unit                {}\n", loaded.unit_text);
  fmt::print("material            {}\n", options.material);
  for (const auto& remark : loaded.remarks) fmt::print("{}\n", remark);
  local::flush_output();
}

// ---- with a window ----

/// The object at its newest placement. `view` is empty of objects before the first pose.
window::ShownObject shown(const feel::LoadedObject& loaded, const feel::ServoView& view) {
  const contact::Placement& placement = view.object_count > 0 ? view.objects[0].placement : loaded.placement;
  // The mesh of the surface is relative to the middle of the object.
  return {std::shared_ptr<const geometry::Mesh>(loaded.surface, &loaded.surface->mesh()),
          placement.to_workspace(loaded.surface->middle_m()), glm::quat(placement.rotation)};
}

/// The window opens when a small object is loaded, or while a large object is loaded.
int feel_in_window(const CommandContext& context, const FeelOptions& options, feel::Loading& loading,
                   contact::Publication& publication, feel::Servo& servo) {
  AwaitedObject awaited(loading, [&](const feel::LoadedObject& loaded) {
    if (!context.device.json) describe(loaded, options);
    publication.publish(scene_of(loaded, options));
  });
  if (loading.is_done_within(silent_time)) awaited.follow();
  if (!awaited.problem().empty()) throw device::Error(awaited.problem());
  const int code = context.open_window([&](window::WindowOptions& window) {
    window.on_pose = [&servo](device::Device& device, const device::DrivenPose& driven) {
      servo.follow(device, driven);
    };
    window.object_loading = [&awaited] { return awaited.follow(); };
    window.shown_objects = [&awaited, &servo] {
      return awaited.object() ? std::vector{shown(*awaited.object(), servo.view())}
                              : std::vector<window::ShownObject>{};
    };
    window.contact_points_m = [&servo] {
      const feel::ServoView view = servo.view();
      std::vector<glm::vec3> points_m;
      for (std::size_t number = 0; number < view.contact_count; ++number)
        points_m.push_back(view.contacts[number].point_m);
      return points_m;
    };
  });
  if (!awaited.problem().empty()) throw device::Error(awaited.problem());
  return code;
}

// ---- without a window ----

void print_status(const DeviceOptions& options, const Pose& pose, double time_s, const feel::ServoView& view) {
  const double force_N = std::hypot(pose.force_N[0], pose.force_N[1], pose.force_N[2]);
  const auto& counters = view.counters;
  if (options.json)
    fmt::print("{}\n", nlohmann::ordered_json{{"time_s", time_s},
                                              {"contacts", view.contact_count},
                                              {"is_grabbed", view.held.has_value()},
                                              {"force_N", force_N},
                                              {"steps", counters.steps},
                                              {"longest_step_s", counters.longest_step_s},
                                              {"models_sent", counters.models_sent}}
                           .dump());
  else
    fmt::print("{:7.1f} s  {:<10} {:5.2f} N  steps {}, longest {:.0f} us, models {}\n", time_s,
               view.held                ? "grabbed"
               : view.contact_count > 0 ? "touched"
                                        : "free",
               force_N, counters.steps, 1e6 * counters.longest_step_s, counters.models_sent);
  local::flush_output();
}

int feel_without_window(const DeviceOptions& device_options, double seconds, feel::Servo& servo) {
  using namespace std::chrono_literals;
  const auto connection = connect(device_options, BoardPace::real_time);
  device::Device& device = *connection.device;
  const protocol::ParameterSet parameters = device.parameters();
  device::request_priority();
  const InterruptGuard interrupt;
  ForceSwitch force(device);
  if (!device_options.json) fmt::print("The force is on. Ctrl-C ends the program.\n");
  local::flush_output();
  std::optional<Pose> waiting;
  std::optional<std::int64_t> begin_periods;
  std::int64_t shown_periods = 0;
  std::optional<std::string> loss;
  while (!loss && !interrupt.is_interrupted()) {
    const Pose pose = waiting ? *waiting : next_pose(device);
    waiting = device.read_pose(0ms);
    servo.follow(device, {pose, parameters, 0, !begin_periods, !waiting});
    device.keep_alive();
    if (!begin_periods) begin_periods = shown_periods = pose.time_periods;
    const double time_s = device::board_time_s(pose.time_periods - *begin_periods);
    const bool is_over = seconds > 0 && time_s >= seconds;
    if (is_over || pose.time_periods - shown_periods >= protocol::servo_rate_Hz) {
      shown_periods = pose.time_periods;
      print_status(device_options, pose, time_s, servo.view());
    }
    if (is_over) break;
    loss = force.loss(pose);
  }
  if (loss) throw device::Error(*loss);
  force.switch_off();
  return 0;
}

void check(const DeviceOptions& device_options, const FeelOptions& options) {
  if (options.file.empty() == options.example.empty())
    throw UsageError(
        "Name one object: a file, as in `inkwell feel skull.stl`, or an example, as in `inkwell feel "
        "--example ball`.");
  if (!options.example.empty() && !options.unit.empty())
    throw UsageError("--unit is the unit of a file, and an example has none. Omit --unit, or use --scale.");
  if (feel::find_material(options.material) == nullptr)
    throw UsageError(
        fmt::format("There is no material {}. Choose one of these: {}.", options.material, feel::material_names()));
  if (options.is_headless) return;
  if (device_options.json) throw UsageError("--json has no meaning with a window. Add --headless, or omit --json.");
  if (options.seconds > 0) throw UsageError("--seconds has no meaning with a window. Add --headless.");
}

int feel_object(const CommandContext& context, const FeelOptions& options) {
  check(context.device, options);
  feel::Loading loading(request_of(context.device, options));
  contact::Publication publication;
  feel::Servo servo(publication);
  if (!options.is_headless) return feel_in_window(context, options, loading, publication, servo);
  const feel::LoadedObject loaded = load(loading);
  if (!context.device.json) describe(loaded, options);
  publication.publish(scene_of(loaded, options));
  return feel_without_window(context.device, options.seconds, servo);
}

std::string example_names() {
  std::string names;
  for (const geometry::Example& example : geometry::examples())
    names += (names.empty() ? "" : ", ") + std::string(example.name);
  return names;
}

void add_object_options(CLI::App& command, FeelOptions& options) {
  command.add_option("FILE", options.file, "Object: STL, OBJ, PLY, glTF 2 (.gltf, .glb) or VRML97 (.wrl, .wrl.gz)")
      ->check(not_empty());
  command.add_option("--example", options.example, "Object without a file: " + example_names())
      ->type_name("NAME")
      ->check(not_empty());
  std::vector<std::string> units;
  for (const importer::Unit unit : importer::all_units) units.emplace_back(importer::symbol_of(unit));
  command
      .add_option("--unit", options.unit,
                  "Unit of the lengths in FILE. Default: the unit of the file, or a suitable one")
      ->check(CLI::IsMember(units));
  command.add_option("--scale", options.scale, "Factor for all lengths (1)")
      ->type_name("FACTOR")
      ->check(more_than_zero());
  command.add_flag("--fit", options.is_fit, "Make the object as large as the workspace allows");
}

}  // namespace

void add_feel_command(const CommandContext& context) {
  auto* command = context.program.add_subcommand(
      "feel",
      "Lets the hand feel an object from a file\n"
      "\n"
      "The window shows the object, and the hand feels it while the force is on. Stylus button 1 grabs the touched\n"
      "object, which follows the stylus until the button is released. The middle of the object is in the middle of "
      "the\n"
      "workspace.");
  const auto options = std::make_shared<FeelOptions>();
  add_object_options(*command, *options);
  command->add_option("--material", options->material, "Material: " + feel::material_names())
      ->type_name("NAME")
      ->capture_default_str();
  command->add_flag("--smooth", options->is_smooth,
                    "Hide the facets of curved surfaces; a smoothed surface can supply energy");
  command->add_flag("--headless", options->is_headless,
                    "Switch the force on without a window, and print one line per second");
  command->add_option("--seconds", options->seconds, "With --headless: stop after this board time. Default: at Ctrl-C")
      ->type_name("SECONDS")
      ->check(more_than_zero());
  add_examples(*command,
               "inkwell feel skull.stl --material skin\ninkwell feel gear.wrl --unit mm --fit\n"
               "inkwell feel --example ball --virtual\ninkwell feel --example ball --headless --seconds 60");
  command->callback(
      [context, options] { context.action = [context, options] { return feel_object(context, *options); }; });
}

}  // namespace inkwell::command_line
