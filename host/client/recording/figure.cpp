#include "host/client/recording/figure.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <system_error>

#include <fmt/format.h>

#include "host/client/device/child_program.hpp"
#include "host/client/local/replaced_file.hpp"
#include "host/client/recording/gnuplot.hpp"
#include "host/client/recording/write_text.hpp"

namespace inkwell::recording {
namespace {

using protocol::Parameter;

constexpr std::size_t points_maximum = 1200;  ///< about one per pixel of the plot's width
constexpr int width_pixels = 1600;
constexpr int titles_pixels = 120, time_axis_pixels = 120;
constexpr int pane_pixels = 320, pane_gap_pixels = 40;
constexpr int names_gap_pixels = 85, names_margin_pixels = 25;        // before and after a name with its line
constexpr double character_pixels = 11.5, names_parts_maximum = 0.3;  // typical width of the characters in signal names
constexpr double tics_maximum = 6;                                    // largest number of tick labels in a pane

constexpr int over_titles_pixels = 30;  // additional height for the titles of the overlaid recording
constexpr std::string_view broken = "dashtype (8,5)", separator = "  ·  ";

constexpr std::array colours = {"blue", "vermilion", "green", "purple", "orange", "sky", "ink"};

/// Returns true if each sample is drawn as one point. Samples of a black box need not be evenly spaced.
bool has_point_each(const StoredRecording& recording, SampleRange shown) {
  return recording.information.step_periods > 1 && shown.end - shown.begin <= points_maximum;
}

std::string name_over(Quantity quantity) { return fmt::format("{}_over", name_of(quantity)); }

/// Returns the quantities that the overlaid recording also contains.
std::vector<Quantity> held_by(const Overlay* over, const std::vector<Quantity>& quantities) {
  std::vector<Quantity> held;
  if (over == nullptr) return held;
  const auto recorded = over->recording().quantities();
  std::ranges::copy_if(quantities, std::back_inserter(held), [&](Quantity each) {
    return std::find(recorded.begin(), recorded.end(), each) != recorded.end();
  });
  return held;
}

/// Appends a band for each range and quantity.
void add_bands(FigureData& data, const StoredRecording& recording, const std::vector<Quantity>& quantities,
               const std::vector<SampleRange>& ranges) {
  std::vector<std::size_t> columns;
  for (const auto quantity : quantities) columns.push_back(recording.column_of(quantity));
  const auto bands = recording.bands(columns, ranges);
  for (std::size_t i = 0; i < ranges.size(); ++i) std::ranges::copy(bands[i], std::back_inserter(data.rows[i].bands));
}

/// Appends the bands of the overlaid recording for the same time ranges.
void add_over(FigureData& data, const Overlay& over, const std::vector<Quantity>& quantities) {
  if (data.rows.empty()) return;
  const StoredRecording& recording = over.recording();
  const auto held = held_by(&over, quantities);
  for (const auto quantity : held) data.names.push_back(name_over(quantity));
  const double step_s =
      data.rows.size() < 2 ? 1.0 / protocol::servo_rate_Hz : data.rows[1].time_s - data.rows[0].time_s;
  std::vector<SampleRange> ranges;
  for (const auto& row : data.rows) {
    const double start_s = row.time_s - 0.5 * step_s - over.begins_s();
    const std::size_t begin = recording.sample_at(start_s), end = recording.sample_at(start_s + step_s);
    ranges.push_back({begin, start_s + step_s <= 0 ? begin : end});
  }
  add_bands(data, recording, held, ranges);
}

FigureData data_of(const StoredRecording& recording, const std::vector<Quantity>& quantities, SampleRange shown,
                   double from_s, double to_s) {
  FigureData data;
  for (const auto quantity : quantities) data.names.emplace_back(name_of(quantity));
  const std::size_t points = std::min(points_maximum, shown.end - shown.begin);
  std::vector<SampleRange> ranges;
  if (has_point_each(recording, shown)) {
    for (std::size_t i = shown.begin; i < shown.end; ++i) {
      data.rows.push_back({recording.elapsed_s(i), {}});
      ranges.push_back({i, i + 1});
    }
  } else {
    // If there are few samples, each sample is one point. The half period compensates for rounding errors.
    const double half_period_s = 0.5 / protocol::servo_rate_Hz;
    const double step_s = (to_s - from_s + 2 * half_period_s) / static_cast<double>(points);
    std::size_t begin = shown.begin;
    for (std::size_t point = 0; point < points; ++point) {
      const double start_s = from_s - half_period_s + step_s * static_cast<double>(point);
      const std::size_t end =
          point + 1 == points ? shown.end : std::min(shown.end, recording.sample_at(start_s + step_s));
      data.rows.push_back({start_s + 0.5 * step_s, {}});
      ranges.push_back({begin, end});
      begin = end;
    }
  }
  add_bands(data, recording, quantities, ranges);
  return data;
}

/// Converts "2026-11-22T04:27:47Z" to "2026-11-22 04:27 UTC". Other formats are returned unchanged.
std::string minute_of(const std::string& utc) {
  constexpr std::size_t date_length = 10, minute_length = 16;
  if (utc.size() <= minute_length || utc[date_length] != 'T' || utc.back() != 'Z') return utc;
  return utc.substr(0, date_length) + " " + utc.substr(date_length + 1, minute_length - date_length - 1) + " UTC";
}

std::string title_of(const StoredRecording& recording) {
  return recording.name + (recording.information.simulation ? " (simulation)" : "");
}

std::vector<std::string> facts_of(const StoredRecording& recording) {
  const auto& about = recording.information;
  std::vector<std::string> parts;
  if (!about.arm.empty()) parts.push_back(about.arm);
  parts.push_back(fmt::format("walls of {} N/m, {} Ns/m", about.parameters[Parameter::wall_stiffness_N_per_m],
                              about.parameters[Parameter::wall_damping_Ns_per_m]));
  parts.push_back("firmware " + about.firmware_version);
  parts.push_back(minute_of(about.created_utc));
  if (recording.lost() > 0) parts.push_back(fmt::format("{} samples lost", recording.lost()));
  if (!recording.complete) parts.push_back("not complete");
  return parts;
}

/// A separate line below the subtitle: the overlaid recording and its differences.
std::string over_titles(const StoredRecording& recording, const Overlay& over, int height) {
  constexpr double over_pixels = 112.0;
  const auto known = facts_of(recording);
  std::string text = fmt::format("broken lines: {}, from {:.3f} s on", title_of(over.recording()), over.begins_s());
  for (const std::string& fact : facts_of(over.recording()))
    if (std::ranges::find(known, fact) == known.end()) text += fmt::format("{}{}", separator, fact);
  return fmt::format("set label 4 {} at graph 0, screen {:.4f} left font 'Inter,16' textcolor rgb grey noenhanced\n",
                     gnuplot_text(text), 1 - over_pixels / height);
}

/// Legend entries for the recordings with solid and with broken lines.
std::string line_kinds(const StoredRecording& recording, const Overlay& over) {
  return fmt::format(
      ", \\\n     NaN with lines linewidth 2 linecolor rgb ink title {}, \\\n"
      "     NaN with lines linewidth 2 linecolor rgb ink {} title {}",
      gnuplot_text(recording.name), broken, gnuplot_text(over.recording().name));
}

std::string time_label(const StoredRecording& recording, double shown_s) {
  if (shown_s * protocol::servo_rate_Hz <= static_cast<double>(points_maximum * recording.information.step_periods))
    return "time  /  s";
  return fmt::format("time  /  s          line: mean of {:.2g} ms, band: its extremes", 1e3 * shown_s / points_maximum);
}

/// Dashed lines through all panes. The texts of the lines are in the first pane only, at staggered heights to avoid
/// overlap.
std::string marks(const StoredRecording& recording, double from_s, double to_s, bool with_text) {
  std::string text;
  int number = 12;  // gnuplot label number, above the numbers of the title and axis labels
  for (const auto& mark : recording.marks) {
    const double at_s = recording.elapsed_s_at(mark.period);
    if (at_s < from_s || at_s > to_s) continue;
    text += fmt::format(
        "set arrow {0} from first {1:.6f}, graph 0 to first {1:.6f}, graph 1 nohead linecolor rgb grey "
        "linewidth 1.2 dashtype 2 front\n",
        number, at_s);
    if (with_text)
      text += fmt::format(
          "set label {} {} at first {:.6f}, graph {} offset 0.4,-0.6 left font 'Inter,15' textcolor rgb grey "
          "noenhanced front\n",
          number, gnuplot_text(mark.text), at_s, 1 - 0.08 * (number % 4));
    ++number;
  }
  return text;
}

/// Right edge of the panes.
double right_edge(const StoredRecording& recording, const Overlay* over, const std::vector<FigurePane>& panes) {
  std::size_t longest = over == nullptr ? 0 : std::max(recording.name.size(), over->recording().name.size());
  for (const auto& pane : panes)
    for (const auto quantity : pane.quantities) longest = std::max(longest, name_of(quantity).size());
  const double names_pixels = names_gap_pixels + character_pixels * static_cast<double>(longest) + names_margin_pixels;
  return 1 - std::min(names_parts_maximum, names_pixels / width_pixels);
}

/// Command for tick labels at round steps with readable spacing. By default, gnuplot draws up to twice as many labels.
std::string tics_of(const FigurePane& pane, const FigureData& data) {
  double smallest = std::numeric_limits<double>::infinity(), largest = -smallest;
  for (std::size_t i = 0; i < data.names.size(); ++i) {
    const auto is_drawn = [&](Quantity quantity) {
      return name_of(quantity) == data.names[i] || name_over(quantity) == data.names[i];
    };
    if (std::none_of(pane.quantities.begin(), pane.quantities.end(), is_drawn)) continue;
    for (const auto& row : data.rows) {
      smallest = std::fmin(smallest, row.bands[i].minimum);
      largest = std::fmax(largest, row.bands[i].maximum);
    }
  }
  if (!(largest > smallest)) return "set ytics autofreq\n";
  const double least_step = (largest - smallest) / tics_maximum;
  const double decade = std::pow(10, std::floor(std::log10(least_step)));
  double step = 10 * decade;
  for (const double part : {5.0, 2.0, 1.0})
    if (part * decade >= least_step) step = part * decade;
  return fmt::format("set ytics {:g}\n", step);
}

std::string script(const StoredRecording& recording, const Overlay* over, const std::vector<FigurePane>& panes,
                   const FigureData& data, double from_s, double to_s) {
  const auto count = static_cast<int>(panes.size());
  const int titles = titles_pixels + (over == nullptr ? 0 : over_titles_pixels);
  const int height = titles + count * pane_pixels + (count - 1) * pane_gap_pixels + time_axis_pixels;
  const double right = right_edge(recording, over, panes);
  std::string text = figure_head("data.csv", width_pixels, height);
  text += fmt::format(
      "set output 'figure.png'\nset multiplot\nset lmargin at screen 0.115\nset rmargin at screen {0:.4f}\n"
      "set xrange [{1:.6f}:{2:.6f}]\nset xzeroaxis linecolor rgb grey linewidth 1 linetype 1\n"
      "set key at screen {3:.4f}, graph 1 left top font 'Inter,16' spacing 1.1\n",
      right, from_s, to_s, right + 0.015);
  text += figure_titles(title_of(recording), fmt::format("{}", fmt::join(facts_of(recording), separator)), height);
  if (over != nullptr) text += over_titles(recording, *over, height);
  text += marks(recording, from_s, to_s, true);
  text += "set format x ''\nunset xlabel\n";
  int top = height - titles;
  for (int i = 0; i < count; ++i, top -= pane_pixels + pane_gap_pixels) {
    const auto& pane = panes[static_cast<std::size_t>(i)];
    if (i == 1) {
      // Without this command, gnuplot would repeat the labels of the first pane in every pane.
      text += "unset label\nunset arrow\n" + marks(recording, from_s, to_s, false);
    }
    if (i + 1 == count)
      text += fmt::format("set format x '%g'\nset xlabel {} textcolor rgb ink\n",
                          gnuplot_text(time_label(recording, to_s - from_s)));
    text += fmt::format("set tmargin at screen {:.4f}\nset bmargin at screen {:.4f}\n",
                        static_cast<double>(top) / height, static_cast<double>(top - pane_pixels) / height);
    // A label replaces ylabel, because the position of ylabel differs between panes.
    text += fmt::format("set label 3 {} at screen 0.018, graph 0.5 center rotate textcolor rgb ink noenhanced\n",
                        gnuplot_text(pane.label));
    text += tics_of(pane, data);
    std::vector<Curve> curves;
    for (std::size_t j = 0; j < pane.quantities.size(); ++j) {
      const std::string colour = colours[j % colours.size()];
      const std::string name(name_of(pane.quantities[j]));
      curves.push_back({name, j < colours.size() ? colour : colour + " dashtype 2", name});
    }
    // These curves are drawn last, so that noise does not hide them.
    for (const auto quantity : held_by(over, pane.quantities)) {
      const auto j = static_cast<std::size_t>(std::find(pane.quantities.begin(), pane.quantities.end(), quantity) -
                                              pane.quantities.begin());
      curves.push_back({name_over(quantity), fmt::format("{} {}", colours[j % colours.size()], broken), ""});
    }
    text += plot_command(curves);
    if (i == 0 && over != nullptr) text.insert(text.size() - 1, line_kinds(recording, *over));
  }
  return text + "unset multiplot\n";
}

/// The text is limited to the length of its axis.
std::string label_of(const std::vector<std::string>& words, std::string_view unit) {
  constexpr std::size_t letters_maximum = 26;
  std::string names = fmt::format("{}", fmt::join(words, ", "));
  if (unit.empty()) {
    for (std::size_t shown = words.size() - 1; names.size() > letters_maximum && shown > 0; --shown)
      names =
          fmt::format("{}, ...", fmt::join(words.begin(), words.begin() + static_cast<std::ptrdiff_t>(shown), ", "));
    return names;
  }
  return names.size() > letters_maximum ? std::string(unit) : fmt::format("{}  /  {}", names, unit);
}

}  // namespace

std::vector<FigurePane> figure_panes(const std::vector<Quantity>& quantities) {
  std::vector<FigurePane> panes;
  std::vector<std::string_view> units;
  std::vector<std::vector<std::string>> words;
  for (const auto quantity : quantities) {
    const auto unit = unit_of(quantity);
    const auto pane = static_cast<std::size_t>(std::find(units.begin(), units.end(), unit) - units.begin());
    if (pane == units.size()) {
      units.push_back(unit);
      panes.emplace_back();
      words.emplace_back();
    }
    panes[pane].quantities.push_back(quantity);
    const auto word = words_of(quantity);
    if (std::find(words[pane].begin(), words[pane].end(), word) == words[pane].end()) words[pane].push_back(word);
  }
  for (std::size_t i = 0; i < panes.size(); ++i) panes[i].label = label_of(words[i], units[i]);
  return panes;
}

void draw_figure(const StoredRecording& recording, const FigureOptions& options, const std::filesystem::path& picture) {
  if (recording.size() == 0) throw device::Error("The recording contains no samples, so there is nothing to draw.");
  const auto quantities = options.quantities.empty() ? recording.quantities() : options.quantities;
  const double end_s = recording.duration_s();
  const double from_s = std::max(0.0, options.from_s), to_s = std::min(end_s, options.to_s.value_or(end_s));
  const SampleRange shown{recording.sample_at(from_s), recording.sample_at(to_s + 0.5 / protocol::servo_rate_Hz)};
  if (shown.end <= shown.begin + 1)
    throw device::Error(fmt::format("There are no samples from {} s to {} s. The recording lasts {:.3f} s.",
                                    options.from_s, options.to_s.value_or(end_s), end_s));

  const auto work = device::make_private_folder();
  FigureData data = data_of(recording, quantities, shown, from_s, to_s);
  if (options.over != nullptr) add_over(data, *options.over, quantities);
  data.write(work.path() / "data.csv");
  write_text(work.path() / "figure.gnuplot",
             script(recording, options.over, figure_panes(quantities), data, from_s, to_s));
  run_gnuplot(work.path() / "figure.gnuplot");
  try {
    local::ReplacedFile next(picture);
    std::filesystem::copy_file(work.path() / "figure.png", next.path());
    next.replace();
  } catch (const std::system_error& error) {
    throw device::Error(fmt::format("{} cannot be written: {}. Give another location with --out.", picture.string(),
                                    error.code().message()));
  }
}

}  // namespace inkwell::recording
