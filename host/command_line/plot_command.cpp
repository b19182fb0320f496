#include "commands.hpp"

#include <filesystem>
#include <memory>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <recording/figure.hpp>
#include <recording/signals.hpp>

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

int plot(const DeviceOptions& device_options, const PlotOptions& options) {
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
  if (device_options.json)
    fmt::print("{}\n", nlohmann::ordered_json{{"picture", picture}}.dump());
  else
    fmt::print("The figure is in {}.\n", picture);
  return 0;
}

}  // namespace

void add_plot_command(CLI::App& program, const DeviceOptions& options, Action& action) {
  auto* command = program.add_subcommand("plot", "Draw a recording against time, one pane for each unit");
  const auto plot_options = std::make_shared<PlotOptions>();
  command->add_option("FILE", plot_options->file, "Written by `inkwell record`")->required();
  command->add_option("--signals", plot_options->signals, "Names with commas between them; all unless given");
  command->add_option("--from", plot_options->from_s, "Start, in seconds since the first sample")
      ->check(CLI::NonNegativeNumber);
  auto* to = command->add_option("--to", plot_options->to_s, "End, in seconds since the first sample")
                 ->check(CLI::PositiveNumber);
  command->add_option("--out", plot_options->picture, "The PNG; beside FILE unless given. It is replaced if it exists");
  command->callback([&options, &action, plot_options, to] {
    plot_options->has_end = to->count() > 0;
    action = [&options, plot_options] { return plot(options, *plot_options); };
  });
}

}  // namespace inkwell::command_line
