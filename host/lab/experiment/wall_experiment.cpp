#include "host/lab/experiment/wall_experiment.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "host/client/device/parameter_file.hpp"
#include "host/client/recording/signals.hpp"
#include "host/client/recording/write_text.hpp"
#include "host/client/recording/writer.hpp"
#include "host/lab/experiment/figures.hpp"
#include "host/lab/experiment/paced_device.hpp"
#include "host/lab/experiment/reach.hpp"
#include "host/lab/experiment/simulated_columns.hpp"
#include "host/lab/experiment/summary.hpp"
#include "host/lab/experiment/summary_json.hpp"
#include "protocol/reports.hpp"

#include "host/lab/experiment/scope_capture.hpp"

namespace inkwell::experiment {
namespace {

using device::Vector3;
using protocol::Command;
using protocol::Parameter;
using protocol::ParameterSet;
using protocol::Signal;
using protocol::State;
using recording::CurrentStep;
using recording::Recording;

// Stiffness and damping of a relaxed human hand.
constexpr double hand_stiffness_N_per_m = 600, hand_damping_Ns_per_m = 8;
constexpr double push_N = 2.4, push_part_of_limit = 0.75;  // force of the hand, within the force limit
constexpr double clear_m = 0.005;                          // distance from the wall before and after the push
constexpr double touch_m = 0.002;                          // target distance inside the wall at the start of the push
constexpr double drag_m = 0.015;                           // along the wall, in the arm's plane

// Times of the hand path since the start of the recording.
constexpr double approached_s = 0.7, touched_s = 1.1, pushed_s = 1.9, held_s = 2.6, dragged_s = 3.2, released_s = 3.6,
                 returned_s = 4.1, end_s = 4.2;
constexpr double settling_s = 0.15;  // from the end of the push's ramp until the hold counts as steady

constexpr float test_amplitude_A = 0.5f, test_duration_s = 0.04f;
constexpr double test_spacing_s = 0.12;

constexpr double user_limit_s = 120, push_limit_s = 30;

/// Returns the probe coordinate at the first contact.
double contact_m(const ParameterSet& parameters, BoxWall wall) {
  return wall_position_m(parameters, wall) - wall.side * static_cast<double>(parameters[Parameter::sphere_radius_m]);
}

Vector3 middle_of_box_m(const ParameterSet& parameters) {
  Vector3 middle{};
  for (int axis = 0; axis < 3; ++axis)
    middle[static_cast<std::size_t>(axis)] =
        (wall_position_m(parameters, {axis, 1}) + wall_position_m(parameters, {axis, -1})) / 2;
  return middle;
}

/// Returns the vertical axis, or a horizontal axis if the wall is horizontal.
std::size_t drag_axis(const ParameterSet& parameters, BoxWall wall) {
  const std::size_t vertical = parameters[Parameter::frame] == 1.0f ? 1 : 2;
  return static_cast<int>(vertical) != wall.axis ? vertical : static_cast<std::size_t>(forward_wall(parameters).axis);
}

std::vector<device::HandWaypoint> hand_path(const ParameterSet& parameters, BoxWall wall) {
  const double force_N =
      std::min(push_N, push_part_of_limit * static_cast<double>(parameters[Parameter::force_limit_N]));
  const double stiffness = std::max(1.0, static_cast<double>(parameters[Parameter::wall_stiffness_N_per_m]));
  const double push_m = force_N / hand_stiffness_N_per_m + force_N / stiffness;
  const Vector3 middle = middle_of_box_m(parameters);
  const auto beyond = [&](double distance_m, double along_m) {
    Vector3 target = middle;
    target[static_cast<std::size_t>(wall.axis)] = contact_m(parameters, wall) + wall.side * distance_m;
    target[drag_axis(parameters, wall)] += along_m;
    return target;
  };
  return {{0.0, middle},
          {approached_s, beyond(-clear_m, 0)},
          {touched_s, beyond(touch_m, 0)},
          {pushed_s, beyond(push_m, 0)},
          {held_s, beyond(push_m, 0)},
          {dragged_s, beyond(push_m, drag_m)},
          {released_s, beyond(-2 * clear_m, drag_m)},
          {returned_s, middle},
          {end_s, middle}};
}

std::size_t samples_of(double time_s) {
  return static_cast<std::size_t>(std::lround(time_s * protocol::servo_rate_Hz));
}

Recording record_current_steps(PacedDevice& device, const recording::Information& about) {
  ScopeCapture capture(device, about);
  for (std::uint8_t motor = 1; motor <= 3; ++motor) {
    device.test_current({motor, test_amplitude_A, test_duration_s});
    device.pass(test_spacing_s);
  }
  return capture.take(capture.size());
}

std::vector<CurrentStep> current_steps(const Recording& recording) {
  std::vector<CurrentStep> steps;
  for (int motor = 0; motor < 3; ++motor)
    steps.push_back(recording::current_step(recording.column(of_axis(Signal::current_reference_1_A, motor)),
                                            recording.column(of_axis(Signal::current_1_A, motor))));
  return steps;
}

void switch_force_on(PacedDevice& device, const ParameterSet& parameters) {
  device.command(Command::enable_force);
  device.wait_for_pose([](const auto& pose) { return protocol::force_is_on(pose.state); }, 1.0,
                       "The device did not switch the force on. Check its state with `inkwell watch`.");
  device.pass(static_cast<double>(parameters[Parameter::force_ramp_s]) + 0.05);
}

struct Push {
  Recording recording;
  std::optional<Interval> hold;  ///< planned interval with a steady hand, if known
};

device::Trace read_trace(device::ControlClient& control) {
  constexpr std::size_t rows_at_once = 4000;
  device::Trace whole = control.trace_read(rows_at_once);
  for (;;) {
    const device::Trace part = control.trace_read(rows_at_once);
    if (part.row_count() == 0) return whole;
    whole.values.insert(whole.values.end(), part.values.begin(), part.values.end());
  }
}

// ---- virtual board --------------------------------------------------------------------------------------

void take_to_middle(PacedDevice& device, device::ControlClient& control, const ParameterSet& parameters) {
  const auto& here = device.pose().position_m;
  const Vector3 here_m{static_cast<double>(here[0]), static_cast<double>(here[1]), static_cast<double>(here[2])};
  control.hand({true, here_m, hand_stiffness_N_per_m, hand_damping_Ns_per_m});
  control.dock(false);
  constexpr double duration_s = 0.8;
  control.hand_path({{0.0, here_m}, {duration_s, middle_of_box_m(parameters)}});
  device.pass(duration_s + 0.2);
}

Push push_by_simulated_hand(PacedDevice& device, device::ControlClient& control, const recording::Information& about,
                            BoxWall wall, const Progress& progress) {
  const ParameterSet& parameters = about.parameters;
  progress("The hand moves the stylus to the middle of the box.", 0.25);
  take_to_middle(device, control, parameters);
  switch_force_on(device, parameters);

  control.trace_start();
  ScopeCapture capture(device, about);
  const std::int64_t path_begins_at = device.pose().time_periods;
  control.hand_path(hand_path(parameters, wall));
  constexpr double step_s = 0.1;
  for (double passed_s = 0; passed_s < end_s; passed_s += step_s) {
    progress(fmt::format("The hand pushes into the wall {}: {:.1f} of {:.1f} s of board time.", wall_name(wall),
                         passed_s, end_s),
             0.3 + 0.5 * passed_s / end_s);
    device.pass(step_s);
  }
  device.pass(step_s);
  Recording recording = capture.take(samples_of(end_s));
  control.trace_stop();
  device.command(Command::disable_force);

  progress("The simulated values are read.", 0.82);
  add_simulated_columns(recording, read_trace(control), recorded_quantities());
  // The offset is negative if the path starts before the first sample.
  const double offset_s = device::board_time_s(path_begins_at - recording.periods.front());
  return {std::move(recording), Interval{offset_s + pushed_s + settling_s, offset_s + held_s - 0.01}};
}

// ---- real device ----------------------------------------------------------------------------------------

bool is_clear(const device::Pose& pose, const ParameterSet& parameters) {
  for (int axis = 0; axis < 3; ++axis) {
    const double position_m = static_cast<double>(pose.position_m[axis]);
    if (position_m > contact_m(parameters, {axis, 1}) - clear_m ||
        position_m < contact_m(parameters, {axis, -1}) + clear_m)
      return false;
  }
  return true;
}

Push push_by_user(PacedDevice& device, const recording::Information& about, BoxWall wall, const Progress& progress) {
  const ParameterSet& parameters = about.parameters;
  progress("Move the stylus out of the inkwell to the middle of the box. The force is switched on there.", 0.25);
  const auto in_the_middle = [&](const auto& pose) {
    return is_clear(pose, parameters) && !is_closed(pose.switches, protocol::Switch::inkwell);
  };
  device.wait_for_pose(in_the_middle, user_limit_s,
                       "The stylus did not reach the middle of the box. Run the experiment again.");
  switch_force_on(device, parameters);

  ScopeCapture capture(device, about);
  progress(fmt::format("Push into the wall {} with increasing force, hold still for a second, then release the stylus.",
                       wall_name(wall)),
           0.4);
  const auto beyond_m = [&](const device::Pose& pose) {
    return wall.side * (static_cast<double>(pose.position_m[wall.axis]) - contact_m(parameters, wall));
  };
  const std::string too_late = "The push into the wall was not finished in 30 s. Run the experiment again.";
  device.wait_for_pose([&](const auto& pose) { return beyond_m(pose) > 0; }, push_limit_s, too_late);
  device.wait_for_pose([&](const auto& pose) { return beyond_m(pose) < -clear_m; }, push_limit_s, too_late);
  device.pass(0.2);
  Recording recording = capture.take(capture.size());
  device.command(Command::disable_force);
  return {std::move(recording), std::nullopt};
}

// ---- both -----------------------------------------------------------------------------------------------

void make_folder(const std::filesystem::path& directory) {
  std::error_code code;
  std::filesystem::create_directories(directory, code);
  if (!std::filesystem::is_directory(directory))
    throw device::Error(fmt::format("The folder {} cannot be created: {}. Give another folder with --out.",
                                    directory.string(), code.message()));
}

/// Throws device::Error if the simulated hand cannot take the probe to the wall.
void check_reach(const ParameterSet& parameters, BoxWall wall) {
  constexpr double tolerance_m = 0.002;
  for (const double along_m : {0.0, drag_m}) {
    Vector3 target = middle_of_box_m(parameters);
    target[static_cast<std::size_t>(wall.axis)] = contact_m(parameters, wall);
    target[drag_axis(parameters, wall)] += along_m;
    const double missing_m = distance_to_reach_m(parameters, target);
    if (missing_m > tolerance_m)
      throw device::Error(
          fmt::format("The probe cannot reach the wall {}: the stops of the arm keep it {:.0f} mm away. Choose another "
                      "wall with --wall, or move this wall with the parameters of the box.",
                      wall_name(wall), 1e3 * missing_m));
  }
}

/// Sets stiffness and damping of the walls until the object is destroyed.
class LentWall {
 public:
  LentWall(device::Device& device, const WallOptions& options) : device_(device) {
    const auto held = device.parameters();
    std::vector<device::ParameterChange> changes;
    const auto set = [&](Parameter parameter, const std::optional<double>& value) {
      if (!value || held[parameter] == static_cast<float>(*value)) return;
      changes.emplace_back(parameter, static_cast<float>(*value));
      held_.emplace_back(parameter, held[parameter]);
    };
    set(Parameter::wall_stiffness_N_per_m, options.stiffness_N_per_m);
    set(Parameter::wall_damping_Ns_per_m, options.damping_Ns_per_m);
    for (const auto& [parameter, value] : changes) device::check_value(parameter, value);
    if (!changes.empty()) device.set_parameters(changes);
  }
  ~LentWall() {
    try {
      if (!held_.empty()) device_.set_parameters(held_);
    } catch (const device::Error&) {  // the device is gone, and with it the changed values
    }
  }
  LentWall(const LentWall&) = delete;
  LentWall& operator=(const LentWall&) = delete;

 private:
  device::Device& device_;
  std::vector<device::ParameterChange> held_;
};

}  // namespace

void check_has_no_experiment(const std::filesystem::path& directory) {
  for (const char* name : {"recording.csv", "current-step.csv", "summary.json"})
    if (std::filesystem::exists(directory / name))
      throw device::Error(fmt::format("{} exists. Give another folder with --out, or remove that experiment.",
                                      (directory / name).string()));
}

nlohmann::ordered_json run_wall_experiment(device::Device& device, device::ControlClient* hand,
                                           const WallOptions& options, const Progress& progress) {
  const auto& directory = options.output_directory;
  check_has_no_experiment(directory);
  make_folder(directory);
  const LentWall lent(device, options);
  Circumstances circumstances;
  circumstances.virtual_board = options.virtual_board;
  auto& about = circumstances.about;
  about = recording::describe(device.information(), device.parameters(), recording::signal_path(), options.arm,
                              options.simulation);
  const BoxWall wall = circumstances.wall = options.wall.value_or(forward_wall(about.parameters));

  if (hand != nullptr) check_reach(about.parameters, wall);

  PacedDevice paced(device, hand);
  progress("Waiting for the stylus to rest in the inkwell.", 0.1);
  paced.wait_for_pose(
      [](const auto& pose) { return pose.state == State::ready || protocol::force_is_on(pose.state); },
      hand != nullptr ? 3.0 : user_limit_s,
      "The arm was not put into its inkwell, so the board does not know where it is. Put the stylus in.");
  if (protocol::force_is_on(paced.pose().state)) paced.command(Command::disable_force);

  progress("The current loops are tested with a pulse in each motor. Leave the stylus in the inkwell.", 0.15);
  const auto steps_recording = record_current_steps(paced, about);
  const auto steps = current_steps(steps_recording);

  const Push push = hand != nullptr ? push_by_simulated_hand(paced, *hand, about, wall, progress)
                                    : push_by_user(paced, about, wall, progress);
  circumstances.poses_received = paced.poses_received();
  circumstances.poses_lost = paced.poses_lost();
  const auto result = evaluate(push.recording, about.parameters, wall, push.hold);
  if (!result.contact)
    throw device::Error(
        fmt::format("The sphere never touched the wall {}. Choose another wall with --wall.", wall_name(wall)));

  progress("The recording is written.", 0.88);
  recording::save(steps_recording, directory / "current-step.csv");
  recording::save(push.recording, directory / "recording.csv");
  progress("The figures are drawn.", 0.94);
  draw_figures(push.recording, directory, {.wall = wall});
  auto summary = summary_json(circumstances, result, steps);
  recording::write_text(directory / "summary.json", summary.dump(2) + '\n');
  progress("Done.", 1.0);
  return summary;
}

}  // namespace inkwell::experiment
