#include <experiment/figures.hpp>

#include <algorithm>
#include <fstream>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include <protocol/reports.hpp>
#include <recording/gnuplot.hpp>

namespace inkwell::experiment {
namespace {

using protocol::Parameter;

constexpr std::size_t samples_per_point = protocol::servo_rate_Hz / 1000;

/// A quantity of the figures: column of the recording, how it is scaled and moved, name in the data.
struct Quantity {
  std::string column;
  double scale = 1;
  double offset = 0;
  std::string name;
};

std::vector<Quantity> quantities(const FigureOptions& options) {
  const double side = options.wall.side;
  const double radius_m = static_cast<double>(options.parameters[Parameter::sphere_radius_m]);
  const double wall_m = wall_position_m(options.parameters, options.wall);
  const char axis = axis_letter(options.wall.axis);
  return {
      // The point of the sphere that touches: above zero it is inside the wall.
      {fmt::format("position_{}_m", axis), 1e3 * side, 1e3 * (radius_m - side * wall_m), "distance_mm"},
      {"force_N", 1, 0, "force_N"},
      {"torque_1_Nm", 1, 0, "torque_1_Nm"},
      {"torque_2_Nm", 1, 0, "torque_2_Nm"},
      {"torque_3_Nm", 1, 0, "torque_3_Nm"},
      {"duty_1", 100, 0, "duty_1_percent"},
      {"duty_2", 100, 0, "duty_2_percent"},
      {"duty_3", 100, 0, "duty_3_percent"},
  };
}

constexpr int width_pixels = 1600, height_pixels = 900;

constexpr char layout[] = R"(set key at screen 0.97, screen 0.845 right top horizontal width 1
set lmargin at screen 0.105
set rmargin at screen 0.97
set tmargin at screen 0.79
set bmargin at screen 0.13
)";

std::string head(const FigureOptions& options, int number, const char* title) {
  const auto& parameters = options.parameters;
  const std::string subtitle = fmt::format(
      "Figure {}  ·  {}{}  ·  wall {}  ·  k = {} N/m, c = {} Ns/m  ·  line: mean of a millisecond, band: its extremes",
      number, options.simulation ? "simulation  ·  " : "", options.arm, wall_name(options.wall),
      parameters[Parameter::wall_stiffness_N_per_m], parameters[Parameter::wall_damping_Ns_per_m]);
  return fmt::format("\nset output 'figure-{}.png'\nunset label\n{}", number,
                     recording::figure_titles(fmt::format("{}{}", title, options.simulation ? " (simulation)" : ""),
                                              subtitle, height_pixels));
}

std::string script(const FigureOptions& options, const Recording& data) {
  std::string text =
      "# Draws figure-11.png to figure-14.png. Made by `inkwell experiment`; run it with: gnuplot figures.gnuplot\n";
  text += recording::figure_head("figure-data.csv", width_pixels, height_pixels) + layout;
  text += fmt::format("set xrange [{:.3f}:{:.3f}]\n", options.shown.from_s, options.shown.to_s);

  const auto largest = data.values_of("distance_mm_maximum");
  const double deepest_mm = std::max(0.5, largest.empty() ? 0.0 : *std::max_element(largest.begin(), largest.end()));
  // The free movement is centimetres, the penetration millimetres: the paper's question is about the latter.
  text += head(options, 11, "Position of the sphere relative to the wall");
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

  text += head(options, 12, "Magnitude of the force");
  text += "set ylabel 'force  /  N' textcolor rgb ink\nset yrange [0:*]\n";
  text += recording::plot_command({{"force_N", "blue", ""}});
  text += "set yrange [*:*]\nset xzeroaxis linecolor rgb grey linewidth 1 linetype 1\n";

  text += head(options, 13, "Torques at the three joints");
  text += "set ylabel 'torque  /  Nm' textcolor rgb ink\n";
  text += recording::plot_command({{"torque_1_Nm", "green", "T1z, waist"},
                                   {"torque_2_Nm", "blue", "T2x, shoulder"},
                                   {"torque_3_Nm", "vermilion", "T3x, elbow"}});

  text += head(options, 14, "Duty of the three bridges");
  text += "set ylabel 'duty  /  % of the supply' textcolor rgb ink\n";
  text += recording::plot_command({{"duty_1_percent", "green", "bridge 1"},
                                   {"duty_2_percent", "blue", "bridge 2"},
                                   {"duty_3_percent", "vermilion", "bridge 3"}});
  return text;
}

}  // namespace

Recording figure_data(const Recording& source, const FigureOptions& options) {
  const auto shown = quantities(options);
  std::vector<std::string> columns{"time_s"};
  std::vector<std::size_t> sources;
  for (const auto& quantity : shown) {
    for (auto& column : recording::band_columns(quantity.name)) columns.push_back(std::move(column));
    sources.push_back(source.column(quantity.column));
  }
  Recording data(columns);
  const std::size_t time = source.column("time_s");
  std::vector<double> row;
  for (std::size_t first = 0; first + samples_per_point <= source.size(); first += samples_per_point) {
    row.assign(1, source.at(first + samples_per_point / 2, time));
    for (std::size_t j = 0; j < shown.size(); ++j) {
      const auto band = recording::band_of(samples_per_point, [&](std::size_t i) {
        return shown[j].scale * source.at(first + i, sources[j]) + shown[j].offset;
      });
      row.insert(row.end(), {band.mean, band.minimum, band.maximum});
    }
    data.append(row);
  }
  return data;
}

void draw_figures(const Recording& source, const FigureOptions& options, const std::filesystem::path& directory) {
  const Recording data = figure_data(source, options);
  write_csv(data, directory / "figure-data.csv");
  std::ofstream stream(directory / "figures.gnuplot", std::ios::binary | std::ios::trunc);
  stream << script(options, data) << std::flush;
  if (!stream) throw device::Error(fmt::format("{} cannot be written. Check the space left.", directory.string()));
  recording::run_gnuplot(directory / "figures.gnuplot");
}

}  // namespace inkwell::experiment
