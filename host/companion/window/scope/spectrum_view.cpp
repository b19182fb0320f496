// View of amplitude over frequency, with two logarithmic axes.
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "host/companion/window/scope/analysis.hpp"
#include "protocol/reports.hpp"

#include "host/companion/window/scope/legend.hpp"
#include "host/companion/window/scope/plot_view.hpp"

namespace inkwell::window {

namespace {

constexpr double sampled_at_Hz = protocol::servo_rate_Hz;
constexpr double decades_of_amplitude = 4.0;
constexpr double lowest_decade_of_frequency = 1.0;

double decibels(double amplitude) { return 20.0 * std::log10(amplitude); }

class SpectrumView final : public PlotView {
 public:
  using PlotView::PlotView;

  void draw(PlotArea area, PlotFrame& frame) override {
    compute(frame);
    const double top_dB = decibels(largest_amplitude());
    area.x = {lowest_decade_of_frequency, std::log10(0.5 * sampled_at_Hz)};
    area.y = shown_range(y_.update(top_dB - 20.0 * decades_of_amplitude, top_dB, ImGui::GetTime()));
    drawn_y_ = area.y;
    ImDrawList& list = *ImGui::GetWindowDrawList();
    draw_axes(list, area, frame.style, "Hz", "dB " + common_unit(plot_), true);
    for (std::size_t i = 0; i < spectra_.size(); ++i)
      draw_points(list, area, points_of(spectra_[i], area), line_colour(frame.style, i), frame.style);
  }

  PlotTable table(const PlotFrame&) const override {
    PlotTable table{.title = plot_.title, .x_name = "frequency_Hz", .y_range = drawn_y_};
    const auto longest =
        std::ranges::max_element(spectra_, {}, [](const Spectrum& each) { return each.amplitudes.size(); });
    if (longest == spectra_.end()) return table;
    for (std::size_t i = 0; i < longest->amplitudes.size(); ++i)
      table.x.push_back(longest->resolution_Hz * static_cast<double>(i));
    table.x_range = {0.0, table.x.empty() ? 1.0 : table.x.back()};
    for (std::size_t i = 0; i < spectra_.size(); ++i) {
      if (spectra_[i].amplitudes.size() != longest->amplitudes.size()) continue;
      table.names.push_back(std::string(plot_.signals[i].name()) + "_dB");
      std::vector<float>& column = table.columns.emplace_back();
      for (const double amplitude : spectra_[i].amplitudes)
        column.push_back(static_cast<float>(decibels(std::max(amplitude, 1e-12))));
    }
    return table;
  }

 private:
  void compute(const PlotFrame& frame) {
    const double now_s = ImGui::GetTime();
    if (now_s - computed_at_s_ <= computed_every_s || frame.stretch.last <= 0.0) return;
    computed_at_s_ = now_s;
    spectra_.clear();
    for (const ScopeSignal& signal : plot_.signals) {
      const SignalSeries* series = frame.timeline.history().find(signal);
      spectra_.push_back(
          series == nullptr ? Spectrum{} : spectrum(*series, frame.stretch.first_index(), frame.stretch.last_index()));
    }
  }

  double largest_amplitude() const {
    double largest = 1e-9;
    for (const Spectrum& each : spectra_)
      for (std::size_t i = 1; i < each.amplitudes.size(); ++i) largest = std::max(largest, each.amplitudes[i]);
    return largest;
  }

  // Returns the maximum amplitude per pixel column.
  static std::vector<std::pair<double, double>> points_of(const Spectrum& spectrum, const PlotArea& area) {
    std::vector<std::pair<double, double>> points;
    float column = -1.0f;
    for (std::size_t i = 1; i < spectrum.amplitudes.size(); ++i) {
      const double x = std::log10(spectrum.resolution_Hz * static_cast<double>(i));
      const double y = decibels(std::max(spectrum.amplitudes[i], 1e-12));
      if (x < area.x.minimum) continue;
      const float pixel = std::floor(area.to_x(x));
      if (pixel == column) {
        points.back().second = std::max(points.back().second, y);
      } else {
        points.emplace_back(x, y);
        column = pixel;
      }
    }
    return points;
  }

  SteadyRange y_;
  std::vector<Spectrum> spectra_;
  double computed_at_s_ = -1.0;
};

}  // namespace

std::unique_ptr<PlotView> spectrum_view(const ScopePlot& plot) { return std::make_unique<SpectrumView>(plot); }

}  // namespace inkwell::window
