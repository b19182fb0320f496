// The figures of an experiment that is over, from its files.
#include <algorithm>
#include <fstream>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <experiment/figures.hpp>
#include <protocol/reports.hpp>

namespace inkwell::experiment {
namespace {

/// What the recording does not say itself: simulation or not, arm, wall, parameters, and when there was contact.
FigureOptions read_options(const std::filesystem::path& file, std::size_t samples) {
  std::ifstream stream(file);
  if (!stream)
    throw device::Error(
        fmt::format("{} is missing. It tells the wall, the parameters and whether the recording is a "
                    "simulation; put it beside the recording.",
                    file.string()));
  try {
    const auto summary = nlohmann::json::parse(stream);
    FigureOptions options;
    options.simulation = summary.at("simulation").get<bool>();
    options.arm = summary.at("arm").get<std::string>();
    options.wall = parse_wall(summary.at("wall").get<std::string>());
    options.parameters = protocol::default_parameters();
    for (std::size_t i = 0; i < protocol::parameter_count; ++i)
      options.parameters.values[i] =
          summary.at("parameters").at(std::string(protocol::parameter_table[i].name)).get<float>();
    const auto& contact = summary.at("contact");
    options.shown = interval_to_show({contact.at("from_s").get<double>(), contact.at("to_s").get<double>()}, samples);
    return options;
  } catch (const nlohmann::json::exception& error) {
    throw device::Error(
        fmt::format("{} is damaged or of another version: {}. Run the experiment again.", file.string(), error.what()));
  }
}

}  // namespace

Interval interval_to_show(Interval contact, std::size_t samples) {
  constexpr double margin_s = 0.25;
  const double end_s = static_cast<double>(samples) / protocol::servo_rate_Hz;
  return {std::max(0.0, contact.from_s - margin_s), std::min(end_s, contact.to_s + margin_s)};
}

bool is_experiment(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::string start(std::string_view("time_s,").size(), ' ');
  return stream.read(start.data(), static_cast<std::streamsize>(start.size())) && start == "time_s,";
}

std::vector<std::string> redraw_figures(const std::filesystem::path& recording, const std::filesystem::path& directory,
                                        double from_s, std::optional<double> to_s) {
  const Recording data = read_csv(recording);
  FigureOptions options = read_options(recording.parent_path() / "summary.json", data.size());
  const double end_s = static_cast<double>(data.size()) / protocol::servo_rate_Hz;
  if (from_s > 0) options.shown.from_s = from_s;
  if (to_s) options.shown.to_s = std::min(end_s, *to_s);
  if (options.shown.from_s >= options.shown.to_s)
    throw device::Error(fmt::format("There are no samples from {} s to {} s. The recording takes {:.3f} s.",
                                    options.shown.from_s, to_s.value_or(end_s), end_s));
  std::error_code code;
  if (!directory.empty()) std::filesystem::create_directories(directory, code);
  if (code)
    throw device::Error(fmt::format("The folder {} cannot be made: {}. Name another one with --out.",
                                    directory.string(), code.message()));
  draw_figures(data, options, directory);
  std::vector<std::string> pictures;
  for (int number = 11; number <= 14; ++number)
    pictures.push_back((directory / fmt::format("figure-{}.png", number)).string());
  return pictures;
}

}  // namespace inkwell::experiment
