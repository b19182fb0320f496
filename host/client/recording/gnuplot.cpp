#include "host/client/recording/gnuplot.hpp"

#include <iterator>

#include <fmt/format.h>

#include "host/client/device/child_program.hpp"
#include "host/client/recording/write_text.hpp"
#include "protocol/plain_text.hpp"

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

/// Returns true if the character has no special meaning in quoted texts of gnuplot.
bool is_harmless(char c) {
  constexpr std::string_view marks = " _.,:;()/+-=<>";
  const bool is_utf8 = (static_cast<unsigned char>(c) & 0x80u) != 0;
  return is_utf8 || (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') ||
         marks.find(c) != marks.npos;
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
    parts.push_back(fmt::format("data using 'time_s':{}:{} with filledcurves fillcolor rgb {} notitle",
                                gnuplot_text(curve.name + "_minimum"), gnuplot_text(curve.name + "_maximum"),
                                curve.style.substr(0, curve.style.find(' '))));
  for (const auto& curve : curves)
    parts.push_back(fmt::format("data using 'time_s':{} with lines linewidth 2 linecolor rgb {} {}",
                                gnuplot_text(curve.name + "_mean"), curve.style,
                                curve.title.empty() ? "notitle" : "title " + gnuplot_text(curve.title)));
  return fmt::format("plot {}\n", fmt::join(parts, ", \\\n     "));
}

std::string gnuplot_text(std::string_view text) {
  std::string quoted = "\"";
  for (const char c : protocol::plain_text(text)) {
    if (is_harmless(c))
      quoted += c;
    else
      // gnuplot reads four octal digits if the first digit is a zero, otherwise three octal digits.
      quoted += fmt::format("\\{:0{}o}", static_cast<unsigned>(c), c < 0100 ? 4 : 3);
  }
  return quoted + "\"";
}

void run_gnuplot(const std::filesystem::path& script) {
  std::string printed;
  const int exit_code =
      device::run_child_program({.words = {"gnuplot", "--default-settings", "./" + script.filename().string()},
                                 .folder = std::filesystem::absolute(script).parent_path(),
                                 .advice = "Install it (Debian: the package gnuplot-nox)."},
                                [&](std::string_view piece) { printed += piece; });
  if (exit_code != 0) throw device::Error(fmt::format("The figure was not drawn. gnuplot printed: {}", printed));
}

}  // namespace inkwell::recording
