#include "host/lab/experiment/figures.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "host/client/recording/write_text.hpp"
#include "protocol/reports.hpp"

namespace inkwell::experiment {
namespace {

using protocol::Parameter;
using protocol::ParameterSet;
using protocol::Signal;
using recording::FigureData;
using recording::StoredRecording;

constexpr std::size_t samples_per_ms = protocol::servo_rate_Hz / 1000;
constexpr std::size_t points_maximum = 5000;  // several for each pixel of the width

/// Returns the duration of a point in a figure.
std::size_t point_ms(Interval shown) {
  return 1 + static_cast<std::size_t>(1000 * (shown.to_s - shown.from_s)) / points_maximum;
}

std::string point_text(Interval shown) {
  const std::size_t ms = point_ms(shown);
  return ms == 1 ? "a millisecond" : fmt::format("{} ms", ms);
}

/// A quantity in the figures.
struct Shown {
  Signal signal;
  double scale;
  double offset;
  std::string name;
};

std::vector<Shown> shown_quantities(const ParameterSet& parameters, BoxWall wall) {
  const double side = wall.side;
  const double radius_m = static_cast<double>(parameters[Parameter::sphere_radius_m]);
  const double wall_m = wall_position_m(parameters, wall);
  return {
      // Depth of the sphere in the wall, negative outside the wall.
      {of_axis(Signal::position_x_m, wall.axis), 1e3 * side, 1e3 * (radius_m - side * wall_m), "distance_mm"},
      {Signal::force_N, 1, 0, "force_N"},
      {Signal::torque_1_Nm, 1, 0, "torque_1_Nm"},
      {Signal::torque_2_Nm, 1, 0, "torque_2_Nm"},
      {Signal::torque_3_Nm, 1, 0, "torque_3_Nm"},
      {Signal::duty_1, 100, 0, "duty_1_percent"},
      {Signal::duty_2, 100, 0, "duty_2_percent"},
      {Signal::duty_3, 100, 0, "duty_3_percent"},
  };
}

constexpr int width_pixels = 1600, height_pixels = 900;

constexpr char layout[] = R"(set key at screen 0.97, screen 0.845 right top horizontal width 1
set lmargin at screen 0.105
set rmargin at screen 0.97
set tmargin at screen 0.79
set bmargin at screen 0.13
)";

std::string head(const recording::Information& about, BoxWall wall, Interval shown, int number, const char* title) {
  const auto& parameters = about.parameters;
  const std::string subtitle = fmt::format(
      "Figure {}  ·  {}{}  ·  wall {}  ·  k = {} N/m, c = {} Ns/m  ·  line: mean of {}, band: its extremes", number,
      about.simulation ? "simulation  ·  " : "", about.arm.empty() ? "unknown arm" : about.arm, wall_name(wall),
      parameters[Parameter::wall_stiffness_N_per_m], parameters[Parameter::wall_damping_Ns_per_m], point_text(shown));
  return fmt::format("\nset output 'figure-{}.png'\nunset label\n{}", number,
                     recording::figure_titles(fmt::format("{}{}", title, about.simulation ? " (simulation)" : ""),
                                              subtitle, height_pixels));
}

/// Returns the contact with a margin at each end.
Interval interval_around(Interval contact, double end_s) {
  constexpr double margin_s = 0.25;
  return {std::max(0.0, contact.from_s - margin_s), std::min(end_s, contact.to_s + margin_s)};
}

std::string script(const recording::Information& about, const FigureData& data, BoxWall wall, Interval shown) {
  std::string text =
      "# Draws figure-11.png to figure-14.png. Made by `inkwell experiment`; run it with: gnuplot figures.gnuplot\n";
  text += recording::figure_head("figure-data.csv", width_pixels, height_pixels) + layout;
  text += fmt::format("set xrange [{:.3f}:{:.3f}]\n", shown.from_s, shown.to_s);

  double deepest_mm = 0.5;
  for (const auto& row : data.rows) deepest_mm = std::max(deepest_mm, row.bands.front().maximum);
  // The axis shows only the penetration, because the free motion is ten times larger.
  text += head(about, wall, shown, 11, "Position of the sphere relative to the wall");
  text += fmt::format(
      "set ylabel 'sphere’s surface beyond the wall  /  mm' textcolor rgb ink\n"
      "set yrange [{0:.3f}:{1:.3f}]\n"
      "set object 1 rectangle from graph 0, first 0 to graph 1, first {1:.3f} behind fillcolor rgb pale "
      "fillstyle solid 0.55 noborder\n"
      "set label 3 'inside the wall' at graph 0.012, first {2:.3f} left textcolor rgb grey\n"
      "set arrow 1 from graph 0, first 0 to graph 1, first 0 nohead linecolor rgb ink linewidth 1.2 front\n",
      -2.0 * deepest_mm, 1.3 * deepest_mm, 1.17 * deepest_mm);
  text += recording::plot_command({{"distance_mm", "blue", ""}});
  text += "unset object 1\nunset arrow 1\nset yrange [*:*]\n";

  text += head(about, wall, shown, 12, "Magnitude of the force");
  text += "set ylabel 'force  /  N' textcolor rgb ink\nset yrange [0:*]\n";
  text += recording::plot_command({{"force_N", "blue", ""}});
  text += "set yrange [*:*]\nset xzeroaxis linecolor rgb grey linewidth 1 linetype 1\n";

  text += head(about, wall, shown, 13, "Torques at the three joints");
  text += "set ylabel 'torque  /  Nm' textcolor rgb ink\n";
  text += recording::plot_command({{"torque_1_Nm", "green", "T1z, waist"},
                                   {"torque_2_Nm", "blue", "T2x, shoulder"},
                                   {"torque_3_Nm", "vermilion", "T3x, elbow"}});

  text += head(about, wall, shown, 14, "Duty of the three bridges");
  text += "set ylabel 'duty  /  % of the supply' textcolor rgb ink\n";
  text += recording::plot_command({{"duty_1_percent", "green", "bridge 1"},
                                   {"duty_2_percent", "blue", "bridge 2"},
                                   {"duty_3_percent", "vermilion", "bridge 3"}});
  return text;
}

}  // namespace

FigureData figure_data(const StoredRecording& recording, BoxWall wall, Interval shown) {
  const auto quantities = shown_quantities(recording.information.parameters, wall);
  FigureData data;
  std::vector<std::size_t> columns;
  for (const auto& quantity : quantities) {
    data.names.push_back(quantity.name);
    columns.push_back(recording.column_of(quantity.signal));
  }
  const std::size_t point_samples = samples_per_ms * point_ms(shown);
  std::vector<recording::SampleRange> ranges;
  const std::size_t end = std::min(recording.size(), recording.sample_at(shown.to_s) + samples_per_ms);
  for (std::size_t first = recording.sample_at(shown.from_s) / samples_per_ms * samples_per_ms;
       first + point_samples <= end; first += point_samples)
    ranges.push_back({first, first + point_samples});
  const auto bands = recording.bands(columns, ranges);
  for (std::size_t i = 0; i < ranges.size(); ++i) {
    FigureData::Row row{recording.elapsed_s(ranges[i].begin + point_samples / 2), {}};
    for (std::size_t j = 0; j < quantities.size(); ++j) {
      const auto [mean, minimum, maximum] = bands[i][j];
      const auto drawn = [&](double value) { return quantities[j].scale * value + quantities[j].offset; };
      row.bands.push_back(
          {drawn(mean), std::min(drawn(minimum), drawn(maximum)), std::max(drawn(minimum), drawn(maximum))});
    }
    data.rows.push_back(std::move(row));
  }
  return data;
}

std::vector<std::string> draw_figures(const StoredRecording& recording, const std::filesystem::path& directory,
                                      const PaperFigureOptions& options) {
  const BoxWall wall = options.wall ? *options.wall : pushed_wall(recording);
  const auto contact = contact_with(recording, wall);
  if (!contact)
    throw device::Error(fmt::format("The sphere does not touch the wall {} in this recording. Record a push into it.",
                                    wall_name(wall)));
  const double end_s = recording.duration_s();
  Interval shown = interval_around(*contact, end_s);
  if (options.from_s) shown.from_s = *options.from_s;
  if (options.to_s) shown.to_s = std::min(end_s, *options.to_s);
  if (shown.from_s >= shown.to_s)
    throw device::Error(fmt::format("There are no samples from {} s to {} s. The recording lasts {:.3f} s.",
                                    shown.from_s, shown.to_s, end_s));
  std::error_code code;
  if (!directory.empty()) std::filesystem::create_directories(directory, code);
  if (code)
    throw device::Error(fmt::format("The folder {} cannot be created: {}. Give another folder with --out.",
                                    directory.string(), code.message()));

  const FigureData data = figure_data(recording, wall, shown);
  data.write(directory / "figure-data.csv");
  recording::write_text(directory / "figures.gnuplot", script(recording.information, data, wall, shown));
  recording::run_gnuplot(directory / "figures.gnuplot");
  std::vector<std::string> pictures;
  for (int number = 11; number <= 14; ++number)
    pictures.push_back((directory / fmt::format("figure-{}.png", number)).string());
  return pictures;
}

}  // namespace inkwell::experiment
