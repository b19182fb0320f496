#include "commands.hpp"

#include <filesystem>
#include <memory>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <experiment/figures.hpp>
#include <recording/figure.hpp>
#include <recording/signals.hpp>

#include "help.hpp"

namespace inkwell::command_line {
namespace {

struct PlotOptions {
  std::string file;
  std::string signals;
  std::string picture;
  double from_s = 0;
  double to_s = 0;
  bool has_end = false;
};

void tell(const DeviceOptions& options, const std::vector<std::string>& pictures) {
  if (options.json)
    fmt::print("{}\n", nlohmann::ordered_json{{"pictures", pictures}}.dump());
  else
    for (const auto& picture : pictures) fmt::print("The figure is in {}.\n", picture);
}

/// The recording of an experiment is drawn as the paper drew it.
int plot_experiment(const DeviceOptions& device_options, const PlotOptions& options) {
  if (!options.signals.empty())
    throw UsageError(
        "The recording of an experiment is drawn as the paper's figures 11 to 14, which have their own "
        "signals. Leave --signals out, or record with `inkwell record`.");
  const std::filesystem::path file = options.file;
  const std::filesystem::path directory =
      options.picture.empty() ? file.parent_path() : std::filesystem::path(options.picture);
  std::optional<double> to_s;
  if (options.has_end) to_s = options.to_s;
  tell(device_options, experiment::redraw_figures(file, directory, options.from_s, to_s));
  return 0;
}

int plot(const DeviceOptions& device_options, const PlotOptions& options) {
  if (experiment::is_experiment(options.file)) return plot_experiment(device_options, options);
  recording::FigureOptions figure{.signals = {}, .from_s = options.from_s, .to_s = std::nullopt};
  try {
    if (!options.signals.empty()) figure.signals = recording::parse_signals(options.signals);
  } catch (const device::Error& error) {
    throw UsageError(error.what());
  }
  if (options.has_end) figure.to_s = options.to_s;
  const auto recording = recording::read(options.file);
  for (const auto& remark : recording.remarks) fmt::print(stderr, "inkwell: {}\n", remark);
  const std::string picture = options.picture.empty()
                                  ? std::filesystem::path(options.file).replace_extension(".png").string()
                                  : options.picture;
  recording::draw_figure(recording, figure, picture);
  tell(device_options, {picture});
  return 0;
}

}  // namespace

void add_plot_command(CLI::App& program, const DeviceOptions& options, Action& action) {
  auto* command =
      program.add_subcommand("plot",
                             "Draw a recording against time, one pane for each unit\n"
                             "The recording.csv of an experiment is drawn as the paper's figures 11 to 14.");
  const auto plot_options = std::make_shared<PlotOptions>();
  command->add_option("FILE", plot_options->file, "Written by `inkwell record` or `inkwell experiment`")->required();
  command->add_option("--signals", plot_options->signals, "Names with commas between them; all unless given")
      ->type_name("NAMES");
  command->add_option("--from", plot_options->from_s, "Start, since the first sample")
      ->type_name("SECONDS")
      ->check(CLI::NonNegativeNumber);
  auto* to = command->add_option("--to", plot_options->to_s, "End, since the first sample")
                 ->type_name("SECONDS")
                 ->check(CLI::PositiveNumber);
  command
      ->add_option("--out", plot_options->picture,
                   "The PNG, or the folder for an experiment's figures; beside FILE unless given")
      ->type_name("PLACE");
  add_examples(*command,
               "inkwell plot push.h5 --signals force_N,position_z_m --from 1 --to 2.5 --out push.png\n"
               "inkwell plot results/recording.csv --out figures");
  command->callback([&options, &action, plot_options, to] {
    plot_options->has_end = to->count() > 0;
    action = [&options, plot_options] { return plot(options, *plot_options); };
  });
}

}  // namespace inkwell::command_line
