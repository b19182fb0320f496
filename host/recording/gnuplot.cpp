#include <recording/gnuplot.hpp>

#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <iterator>

#include <fmt/format.h>

#include <device/error.hpp>
#include <recording/write_text.hpp>

namespace inkwell::recording {
namespace {

constexpr char look[] =
#include <figure_style.inc>
    ;

constexpr char layout[] = R"(set datafile separator comma
set datafile columnheaders
set key outside right top vertical Left reverse samplen 1.6 spacing 1.25 textcolor rgb ink noenhanced
set xlabel 'time  /  s' textcolor rgb ink
set style fill transparent solid 0.22 noborder
)";

std::string shell_quoted(const std::string& text) {
  std::string result = "'";
  for (char character : text) result += character == '\'' ? std::string("'\\''") : std::string(1, character);
  return result + "'";
}

}  // namespace

void FigureData::write(const std::filesystem::path& file) const {
  fmt::memory_buffer text;
  const auto out = std::back_inserter(text);
  fmt::format_to(out, "time_s");
  for (const auto& name : names) fmt::format_to(out, ",{0}_mean,{0}_minimum,{0}_maximum", name);
  for (const auto& row : rows) {
    fmt::format_to(out, "\n{:.7g}", row.time_s);
    for (const auto& band : row.bands)
      fmt::format_to(out, ",{:.7g},{:.7g},{:.7g}", band.mean, band.minimum, band.maximum);
  }
  fmt::format_to(out, "\n");
  write_text(file, {text.data(), text.size()});
}

std::string figure_head(const std::string& data_file, int width, int height) {
  return fmt::format(
      "data = {}\nset terminal pngcairo size {},{} font 'Inter,20' background '#ffffff' linewidth 1.4\n{}{}",
      gnuplot_text(data_file), width, height, look, layout);
}

std::string figure_titles(std::string_view title, std::string_view subtitle, int height) {
  constexpr double title_pixels = 40.0, subtitle_pixels = 85.0;
  return fmt::format(
      "set label 1 {} at graph 0, screen {:.4f} left font 'Inter:Bold,26' textcolor rgb ink noenhanced\n"
      "set label 2 {} at graph 0, screen {:.4f} left font 'Inter,16' textcolor rgb grey noenhanced\n",
      gnuplot_text(title), 1 - title_pixels / height, gnuplot_text(subtitle), 1 - subtitle_pixels / height);
}

std::string plot_command(const std::vector<Curve>& curves) {
  std::vector<std::string> parts;
  for (const auto& curve : curves)
    parts.push_back(
        fmt::format("data using 'time_s':'{0}_minimum':'{0}_maximum' with filledcurves fillcolor rgb {1} notitle",
                    curve.name, curve.style.substr(0, curve.style.find(' '))));
  for (const auto& curve : curves)
    parts.push_back(fmt::format("data using 'time_s':'{0}_mean' with lines linewidth 2 linecolor rgb {1} {2}",
                                curve.name, curve.style,
                                curve.title.empty() ? "notitle" : "title " + gnuplot_text(curve.title)));
  return fmt::format("plot {}\n", fmt::join(parts, ", \\\n     "));
}

std::string gnuplot_text(std::string_view text) {
  std::string result = "'";
  for (char character : text) result += character == '\'' ? "''" : character == '\n' ? " " : std::string(1, character);
  return result + "'";
}

void run_gnuplot(const std::filesystem::path& script) {
  const auto directory = std::filesystem::absolute(script).parent_path();
  const std::string command = fmt::format("cd {} && gnuplot {} 2>&1", shell_quoted(directory.string()),
                                          shell_quoted("./" + script.filename().string()));
  std::FILE* pipe = popen(command.c_str(), "r");
  if (pipe == nullptr) throw device::Error("gnuplot cannot be started: the system allows no more processes.");
  std::string said;
  std::array<char, 512> chunk;
  while (const std::size_t length = std::fread(chunk.data(), 1, chunk.size(), pipe)) said.append(chunk.data(), length);
  const int status = pclose(pipe);
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0)
    throw device::Error(
        fmt::format("The figure was not drawn. Install gnuplot-nox if it is missing. The shell said: {}", said));
}

}  // namespace inkwell::recording
