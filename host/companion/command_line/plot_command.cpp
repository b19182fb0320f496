#include "host/companion/command_line/commands.hpp"

#include <filesystem>
#include <memory>
#include <tuple>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "host/client/command_line/help.hpp"
#include "host/client/local/text_file.hpp"
#include "host/client/recording/figure.hpp"
#include "host/client/recording/signals.hpp"
#include "host/lab/experiment/figures.hpp"

#include "host/companion/command_line/read_recording.hpp"

namespace inkwell::command_line {
namespace {

struct PlotOptions {
  std::string file;
  std::string signals;
  std::string output;
  std::optional<double> from_s, to_s;
  bool as_in_paper = false;
  std::string over;
  std::string align;
};

void print_pictures(const DeviceOptions& options, const std::vector<std::string>& pictures) {
  if (options.json)
    fmt::print("{}\n", nlohmann::ordered_json{{"pictures", pictures}}.dump());
  else
    for (const auto& picture : pictures) fmt::print("The figure is in {}.\n", picture);
}

std::vector<std::string> draw_as_in_paper(const recording::StoredRecording& recording, const PlotOptions& options) {
  const auto folder = options.output.empty() ? std::filesystem::path(options.file).parent_path()
                                             : std::filesystem::path(options.output);
  return experiment::draw_figures(recording, folder, {.wall = {}, .from_s = options.from_s, .to_s = options.to_s});
}

std::string draw(recording::StoredRecording recording, const PlotOptions& options) {
  if (!options.output.empty() && !local::has_extension(options.output, ".png"))
    throw UsageError(
        fmt::format("{} does not end in .png. Figures are PNG files; give a name that ends in .png.", options.output));
  recording::FigureOptions figure{.quantities = {}, .from_s = options.from_s.value_or(0), .to_s = options.to_s};
  std::optional<recording::Overlay> over;
  if (!options.over.empty()) {
    auto other = open_recording(options.over);
    std::tie(recording.name, other.name) = recording::distinct_names(options.file, options.over);
    over.emplace(std::move(other), recording, options.align);
  }
  if (over) figure.over = &*over;
  try {
    if (!options.signals.empty()) figure.quantities = recording::parse_quantities(options.signals);
  } catch (const device::Error& error) {
    throw UsageError(error.what());
  }
  const std::string picture =
      options.output.empty() ? std::filesystem::path(options.file).replace_extension(".png").string() : options.output;
  recording::draw_figure(recording, figure, picture);
  return picture;
}

int plot(const DeviceOptions& device_options, const PlotOptions& options) {
  auto recording = open_recording(options.file);
  if (options.as_in_paper)
    print_pictures(device_options, draw_as_in_paper(recording, options));
  else
    print_pictures(device_options, {draw(std::move(recording), options)});
  return 0;
}

}  // namespace

void add_plot_command(const CommandContext& context) {
  auto* command = context.program.add_subcommand(
      "plot", "Plots a recording over time with one pane per unit, or like the paper's figures");
  const auto plot_options = std::make_shared<PlotOptions>();
  command->add_option("FILE", plot_options->file, "Recording from `inkwell record` or `inkwell experiment`")
      ->required();
  auto* signals = command
                      ->add_option("--signals", plot_options->signals,
                                   "Comma-separated names of signals or simulated quantities. Default: all signals")
                      ->type_name("NAMES");
  auto* paper =
      command->add_flag("--paper", plot_options->as_in_paper,
                        "Plot a wall push like figures 11 to 14 of Eriksson and Wikander; not with --signals");
  paper->excludes(signals);
  auto* over =
      command->add_option("--over", plot_options->over, "Second recording, plotted over FILE with dashed lines")
          ->type_name("FILE")
          ->excludes(paper);
  command
      ->add_option("--align", plot_options->align,
                   "Text of the mark that aligns both recordings. Default: their first samples")
      ->type_name("MARK")
      ->needs(over);
  command->add_option("--from", plot_options->from_s, "Start time after the first sample")
      ->type_name("SECONDS")
      ->check(zero_or_more());
  command->add_option("--to", plot_options->to_s, "End time after the first sample")
      ->type_name("SECONDS")
      ->check(more_than_zero());
  command->add_option("--out", plot_options->output, "PNG file, or folder for --paper. Default: next to FILE")
      ->type_name("PATH");
  add_examples(*command,
               "inkwell plot push.h5 --signals force_N,position_z_m --from 1 --to 2.5 --out push.png\n"
               "inkwell plot results/recording.csv --signals current_1_A,true_current_1_A\n"
               "inkwell plot soft.h5 --over stiff.h5 --align touch --signals force_N\n"
               "inkwell plot results/recording.csv --paper --out figures");
  command->callback([context, plot_options] {
    context.action = [&options = context.device, plot_options] { return plot(options, *plot_options); };
  });
}

}  // namespace inkwell::command_line
