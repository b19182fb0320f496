#include <experiment/figures.hpp>

#include <sys/wait.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <fstream>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include <protocol/reports.hpp>

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

// Blue, vermilion and green of Okabe and Ito: told apart with every kind of colour blindness.
constexpr char script_head[] = R"(# Draws figure-11.png to figure-14.png. Made by `inkwell experiment`; run it with: gnuplot figures.gnuplot
set datafile separator comma
set datafile columnheaders
data = 'figure-data.csv'
set terminal pngcairo size 1600,900 font 'Inter,20' background '#ffffff' linewidth 1.4
set encoding utf8
ink = '#24292f'; grey = '#6b7280'; pale = '#e5e7eb'
blue = '#0072b2'; vermilion = '#d55e00'; green = '#009e73'
set border 3 linecolor rgb grey linewidth 1
set tics nomirror out scale 0.6 textcolor rgb ink
set grid linecolor rgb pale linewidth 0.8 linetype 1
set key at screen 0.97, screen 0.845 right top horizontal Left reverse samplen 1.6 width 1 textcolor rgb ink noenhanced
set xlabel 'time  /  s' textcolor rgb ink
set lmargin at screen 0.105
set rmargin at screen 0.97
set tmargin at screen 0.79
set bmargin at screen 0.13
set style fill transparent solid 0.22 noborder
)";

struct Curve {
  std::string name;    ///< in the data
  std::string colour;  ///< variable of the script
  std::string title;   ///< in the legend; none where the axis says it
};

/// A band from the smallest to the largest value of each millisecond, and its mean as a line.
std::string plot_command(const std::vector<Curve>& curves) {
  std::vector<std::string> parts;
  for (const auto& curve : curves)
    parts.push_back(fmt::format("data using 'time_s':'{0}_minimum':'{0}_maximum' with filledcurves fillcolor rgb {1} notitle",
                                curve.name, curve.colour));
  for (const auto& curve : curves)
    parts.push_back(fmt::format("data using 'time_s':'{0}_mean' with lines linewidth 2 linecolor rgb {1} {2}", curve.name,
                                curve.colour, curve.title.empty() ? "notitle" : "title '" + curve.title + "'"));
  return fmt::format("plot {}\n", fmt::join(parts, ", \\\n     "));
}

/// For a string in single quotes of gnuplot or the shell: `quote` stands for a quote within it.
std::string quoted(const std::string& text, std::string_view quote) {
  std::string result;
  for (char character : text) character == '\'' ? result += quote : result += character;
  return result;
}

std::string head(const FigureOptions& options, int number, const char* title) {
  const auto& parameters = options.parameters;
  const std::string subtitle = fmt::format(
      "Figure {}  ·  {}{}  ·  wall {}  ·  k = {} N/m, c = {} Ns/m  ·  line: mean of a millisecond, band: its extremes",
      number, options.simulation ? "simulation  ·  " : "", quoted(options.arm, "''"), wall_name(options.wall),
      parameters[Parameter::wall_stiffness_N_per_m], parameters[Parameter::wall_damping_Ns_per_m]);
  return fmt::format(
      "\nset output 'figure-{0}.png'\nunset label\n"
      "set label 1 '{1}{2}' at graph 0, screen 0.955 left font 'Inter:Bold,26' textcolor rgb ink noenhanced\n"
      "set label 2 '{3}' at graph 0, screen 0.905 left font 'Inter,16' textcolor rgb grey noenhanced\n",
      number, title, options.simulation ? " (simulation)" : "", subtitle);
}

std::string script(const FigureOptions& options, const Recording& data) {
  std::string text = script_head;
  text += fmt::format("set xrange [{:.3f}:{:.3f}]\n", options.shown.from_s, options.shown.to_s);

  const auto largest = data.values_of("distance_mm_maximum");
  const double deepest_mm = std::max(0.5, largest.empty() ? 0.0 : *std::max_element(largest.begin(), largest.end()));
  // The free movement is centimetres, the penetration millimetres: the paper's question is about the latter.
  text += head(options, 11, "Position of the sphere relative to the wall");
  text += fmt::format("set ylabel 'sphere’s surface beyond the wall  /  mm' textcolor rgb ink\n"
                      "set yrange [{0:.3f}:{1:.3f}]\n"
                      "set object 1 rectangle from graph 0, first 0 to graph 1, first {1:.3f} behind fillcolor rgb pale "
                      "fillstyle solid 0.55 noborder\n"
                      "set label 3 'inside the wall' at graph 0.012, first {2:.3f} left textcolor rgb grey\n"
                      "set arrow 1 from graph 0, first 0 to graph 1, first 0 nohead linecolor rgb ink linewidth 1.2 front\n",
                      -2.0 * deepest_mm, 1.3 * deepest_mm, 1.17 * deepest_mm);
  text += plot_command({{"distance_mm", "blue", ""}});
  text += "unset object 1\nunset arrow 1\nset yrange [*:*]\n";

  text += head(options, 12, "Magnitude of the force");
  text += "set ylabel 'force  /  N' textcolor rgb ink\nset yrange [0:*]\n";
  text += plot_command({{"force_N", "blue", ""}});
  text += "set yrange [*:*]\nset xzeroaxis linecolor rgb grey linewidth 1 linetype 1\n";

  text += head(options, 13, "Torques at the three joints");
  text += "set ylabel 'torque  /  Nm' textcolor rgb ink\n";
  text += plot_command({{"torque_1_Nm", "green", "T1z, waist"}, {"torque_2_Nm", "blue", "T2x, shoulder"},
                        {"torque_3_Nm", "vermilion", "T3x, elbow"}});

  text += head(options, 14, "Duty of the three bridges");
  text += "set ylabel 'duty  /  % of the supply' textcolor rgb ink\n";
  text += plot_command({{"duty_1_percent", "green", "bridge 1"}, {"duty_2_percent", "blue", "bridge 2"},
                        {"duty_3_percent", "vermilion", "bridge 3"}});
  return text;
}

void run_gnuplot(const std::filesystem::path& directory) {
  const std::string command =
      fmt::format("cd '{}' && gnuplot figures.gnuplot 2>&1", quoted(directory.string(), "'\\''"));
  std::FILE* pipe = popen(command.c_str(), "r");
  if (pipe == nullptr) throw device::Error("gnuplot cannot be started: the system allows no more processes.");
  std::string said;
  std::array<char, 512> chunk;
  while (const std::size_t length = std::fread(chunk.data(), 1, chunk.size(), pipe)) said.append(chunk.data(), length);
  const int status = pclose(pipe);
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0)
    throw device::Error(fmt::format("The figures were not drawn. Install gnuplot-nox. The shell said: {}", said));
}

}  // namespace

Recording figure_data(const Recording& recording, const FigureOptions& options) {
  const auto shown = quantities(options);
  std::vector<std::string> columns{"time_s"};
  std::vector<std::size_t> sources;
  for (const auto& quantity : shown) {
    for (const char* kind : {"mean", "minimum", "maximum"}) columns.push_back(quantity.name + "_" + kind);
    sources.push_back(recording.column(quantity.column));
  }
  Recording data(columns);
  const std::size_t time = recording.column("time_s");
  std::vector<double> row;
  for (std::size_t first = 0; first + samples_per_point <= recording.size(); first += samples_per_point) {
    row.assign(1, recording.at(first + samples_per_point / 2, time));
    for (std::size_t j = 0; j < shown.size(); ++j) {
      double sum = 0, smallest = 0, largest = 0;
      for (std::size_t i = 0; i < samples_per_point; ++i) {
        const double value = shown[j].scale * recording.at(first + i, sources[j]) + shown[j].offset;
        smallest = i == 0 ? value : std::min(smallest, value);
        largest = i == 0 ? value : std::max(largest, value);
        sum += value;
      }
      row.insert(row.end(), {sum / samples_per_point, smallest, largest});
    }
    data.append(row);
  }
  return data;
}

void draw_figures(const Recording& recording, const FigureOptions& options, const std::filesystem::path& directory) {
  const Recording data = figure_data(recording, options);
  write_csv(data, directory / "figure-data.csv");
  std::ofstream stream(directory / "figures.gnuplot", std::ios::binary | std::ios::trunc);
  stream << script(options, data) << std::flush;
  if (!stream) throw device::Error(fmt::format("{} cannot be written. Check the space left.", directory.string()));
  run_gnuplot(directory);
}

}  // namespace inkwell::experiment
