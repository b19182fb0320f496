#include "host/companion/command_line/commands.hpp"

#include <algorithm>
#include <memory>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include "host/client/command_line/help.hpp"

#include "host/companion/command_line/force_delay.hpp"
#include "host/companion/command_line/force_switch.hpp"
#include "host/companion/command_line/next_pose.hpp"

namespace inkwell::command_line {
namespace {

using nlohmann::ordered_json;

struct DelayOptions {
  int recordings = 100;
  bool is_held = false;  ///< the user holds the stylus of a real arm
};

/// During a measurement, sets the rate limit of the force to the maximum.
class FastForce {
 public:
  explicit FastForce(device::Device& device) : device_(device), stored_(device.parameters()[parameter]) {
    set(info(parameter).maximum);
  }
  ~FastForce() {
    try {
      set(stored_);
    } catch (const device::Error&) {  // the device is gone, and so is the changed value
    }
  }
  FastForce(const FastForce&) = delete;
  FastForce& operator=(const FastForce&) = delete;

 private:
  static constexpr auto parameter = protocol::Parameter::program_force_change_N_per_s;
  void set(float value) { device_.set_parameters(std::vector<device::ParameterChange>{{parameter, value}}); }

  device::Device& device_;
  const float stored_;
};

/// Moves the simulated hand to the middle of the box, where the hand holds the stylus.
void hold(device::OpenArm& arm) {
  constexpr device::Vector3 middle_m{0, 0, -0.03};
  auto pose = next_pose(*arm.device);
  for (const std::int64_t begin_periods = pose.time_periods; pose.state != protocol::State::ready;
       pose = next_pose(*arm.device))
    if (pose.time_periods - begin_periods > 5 * protocol::servo_rate_Hz) throw device::Error(force_sentence(pose));
  arm.control->hand({.holds = true, .target_m = middle_m, .stiffness_N_per_m = 1500, .damping_Ns_per_m = 15});
  arm.control->dock(false);
  const std::int64_t begin_periods = next_pose(*arm.device).time_periods;
  while (next_pose(*arm.device).time_periods - begin_periods < protocol::servo_rate_Hz / 2) arm.device->keep_alive();
}

ordered_json to_json(const Transmission& transmission) {
  return {{"gain", transmission.gain}, {"delay_ms", transmission.delay_ms}};
}

ordered_json to_json(const ForceDelay& delay, bool is_simulation) {
  ordered_json recordings = ordered_json::array(), responses = ordered_json::array();
  for (const auto& [shortest_ms, longest_ms] : delay.recordings)
    recordings.push_back({{"shortest_ms", shortest_ms}, {"longest_ms", longest_ms}});
  for (const auto& response : delay.responses)
    responses.push_back({{"frequency_Hz", response.frequency_Hz},
                         {"program_force", to_json(response.program_force)},
                         {"current", to_json(response.current)}});
  return {{"is_simulation", is_simulation},
          {"poses_missed", delay.poses_missed},
          {"recordings", recordings},
          {"responses", responses}};
}

void print(const ForceDelay& delay, bool is_simulation) {
  const auto shortest = std::ranges::min_element(delay.recordings, {}, &ForceDelay::Recording::shortest_ms);
  const auto longest = std::ranges::max_element(delay.recordings, {}, &ForceDelay::Recording::longest_ms);
  fmt::print("Delay from pose to force, {} recordings{}: {:.2f} to {:.2f} ms; {} poses were missed.\n\n",
             delay.recordings.size(), is_simulation ? " (simulation)" : "", shortest->shortest_ms, longest->longest_ms,
             delay.poses_missed);
  fmt::print("{:>9}  {:>21}  {:>21}\n", "", "force of the program", "current of motor 1");
  fmt::print("{:>9}  {:>8} {:>12}  {:>8} {:>12}\n", "frequency", "gain", "delay", "gain", "delay");
  for (const auto& [frequency_Hz, force, current] : delay.responses)
    fmt::print("{:>6.0f} Hz  {:>8.3f} {:>9.2f} ms  {:>8.3f} {:>9.3f} ms\n", frequency_Hz, force.gain, force.delay_ms,
               current.gain, current.delay_ms);
}

int measure_delay(const DeviceOptions& options, const DelayOptions& wanted) {
  auto arm = connect(options, BoardPace::lock_step);
  if (arm.control)
    hold(arm);
  else if (!arm.endpoint.is_virtual && !wanted.is_held)
    throw UsageError(
        "The arm pushes back and forth with up to 0.5 N. Hold the stylus in the middle of the box, and add --yes.");
  const auto delay = [&] {
    ForceSwitch force(*arm.device);
    const FastForce fast_force(*arm.device);
    return measure_force_delay(*arm.device, wanted.recordings, {20, 50, 100, 200});
  }();
  if (options.json)
    fmt::print("{}\n", to_json(delay, arm.endpoint.is_virtual).dump(1));
  else
    print(delay, arm.endpoint.is_virtual);
  return 0;
}

}  // namespace

void add_measure_command(const CommandContext& context) {
  auto* command = context.program.add_subcommand("measure", "Measures the timing of the arm");
  command->require_subcommand(1);
  add_examples(*command, "inkwell measure delay --virtual");
  auto* delay = command->add_subcommand(
      "delay", "Measures the delay from a pose to the force computed from it, and the frequency response");
  const auto wanted = std::make_shared<DelayOptions>();
  delay
      ->add_option("--recordings", wanted->recordings,
                   "Number of 60 ms recordings for the delay measurement, 1 to 1000")
      ->type_name("NUMBER")
      ->check(whole_number_within(1, 1000))
      ->capture_default_str();
  delay->add_flag("--yes", wanted->is_held,
                  "Confirm that you hold the stylus of the real arm, which pushes with up to 0.5 N");
  add_examples(*delay, "inkwell measure delay --virtual\ninkwell measure delay --recordings 20 --yes --json");
  delay->callback([context, wanted] {
    context.action = [&options = context.device, wanted] { return measure_delay(options, *wanted); };
  });
}

}  // namespace inkwell::command_line
