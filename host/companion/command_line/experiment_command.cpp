#include "host/companion/command_line/commands.hpp"

#include <memory>

#include <fmt/format.h>

#include "host/client/command_line/help.hpp"
#include "host/lab/experiment/wall_experiment.hpp"

#include "host/companion/command_line/progress_bar.hpp"

namespace inkwell::command_line {
namespace {

struct WallCommandOptions {
  std::string output = "wall-experiment";
  std::string wall;
  std::optional<double> stiffness_N_per_m, damping_Ns_per_m;
};

void print(const nlohmann::ordered_json& summary, const std::string& directory) {
  const auto number = [&](const char* name) { return summary.at(name).get<double>(); };
  if (summary.at("simulation").get<bool>()) fmt::print("This is a simulation: a virtual board, arm and hand.\n");
  fmt::print("wall {}           {} samples, {} lost; {} in contact\n", summary.at("wall").get<std::string>(),
             summary.at("samples").get<std::size_t>(), summary.at("samples_lost").get<std::size_t>(),
             summary.at("samples_in_contact").get<std::size_t>());
  fmt::print("penetration      {:.2f} mm at most\n", 1e3 * number("penetration_maximum_m"));
  fmt::print("force            {:.2f} N at most; within {:.2f} mN of k d + c d'\n", number("force_maximum_N"),
             1e3 * summary.at("force_law").at("error_maximum_N").get<double>());
  fmt::print("torque           T1z {:.2f} mNm at most, T2x and T3x {:.0f} mNm\n", 1e3 * number("torque_1_maximum_Nm"),
             1e3 * number("torque_2_and_3_maximum_Nm"));
  if (summary.contains("steady_hold"))
    fmt::print("steady hold      {:.0f} encoder counts, {:.3f} mm, in {:.2f} s\n",
               summary["steady_hold"]["encoder_spread_counts"].get<double>(),
               1e3 * summary["steady_hold"]["position_spread_m"].get<double>(),
               summary["steady_hold"]["duration_s"].get<double>());
  if (summary.contains("current_step"))
    fmt::print("current step     63 % after {:.0f} us, overshoot {:.1f} %, steady error {:.1f} mA\n",
               1e6 * summary["current_step"]["rise_time_s"].get<double>(),
               1e2 * summary["current_step"]["overshoot"].get<double>(),
               1e3 * summary["current_step"]["steady_error_A"].get<double>());
  fmt::print("written          {}: recording.csv, summary.json, figure-11.png to figure-14.png\n", directory);
}

int run_wall(DeviceOptions options, const WallCommandOptions& command) {
  experiment::check_has_no_experiment(command.output);
  options.is_strict = true;  // a result with a violated chip rule would be invalid
  ProgressBar progress;
  experiment::WallOptions wall{.output_directory = command.output,
                               .stiffness_N_per_m = command.stiffness_N_per_m,
                               .damping_Ns_per_m = command.damping_Ns_per_m};
  if (!command.wall.empty()) wall.wall = experiment::parse_wall(command.wall);
  constexpr auto mode = device::SimulationMode::exact;
  constexpr auto pace = BoardPace::as_asked;
  if (options.is_virtual) {
    progress("Starting the virtual board.", 0.0);
    wall.virtual_board = options.virtual_board(mode, pace);
  }
  auto connection = connect(options, pace, mode);
  wall.arm = connection.arm_name;
  wall.simulation = connection.endpoint.is_virtual;
  const auto summary = experiment::run_wall_experiment(
      *connection.device, connection.control ? &*connection.control : nullptr, wall, progress);
  if (options.json)
    fmt::print("{}\n", summary.dump(2));
  else
    print(summary, command.output);
  return 0;
}

}  // namespace

void add_experiment_command(const CommandContext& context) {
  auto* command =
      context.program.add_subcommand("experiment", "Experiments that record every control period and draw figures");
  command->require_subcommand(1);
  add_examples(*command, "inkwell experiment wall --virtual --out results");
  auto* wall = command->add_subcommand(
      "wall",
      "Repeats the wall experiment of Eriksson and Wikander, section 4.3\n"
      "The sphere around the probe is pushed into a wall. With --virtual a simulated hand pushes; otherwise the\n"
      "program prompts you to push.");
  const auto wall_options = std::make_shared<WallCommandOptions>();
  wall->add_option("--out", wall_options->output, "Folder for recording.csv, summary.json and the figures")
      ->type_name("FOLDER")
      ->capture_default_str();
  wall->add_option("--wall", wall_options->wall,
                   "Wall to push into: axis and side. Default: the wall in front of the arm")
      ->check(CLI::IsMember({"x-", "x+", "y-", "y+", "z-", "z+"}));
  wall->add_option("--stiffness", wall_options->stiffness_N_per_m,
                   "Stiffness of the wall during the experiment. Default: wall_stiffness_N_per_m of the arm")
      ->type_name("N/m");
  wall->add_option("--damping", wall_options->damping_Ns_per_m,
                   "Damping of the wall during the experiment. Default: wall_damping_Ns_per_m of the arm")
      ->type_name("Ns/m");
  add_examples(*wall,
               "inkwell experiment wall --virtual --out results\n"
               "inkwell experiment wall --virtual --arm boards/arms/paper.toml --out results-paper\n"
               "inkwell experiment wall --wall y- --stiffness 1500 --damping 3 --out results-stiff");
  wall->callback([context, wall_options] {
    context.action = [&options = context.device, wall_options] { return run_wall(options, *wall_options); };
  });
}

}  // namespace inkwell::command_line
