#include "host/companion/window/scope/statistics_text.hpp"

#include <cmath>

#include <fmt/format.h>

namespace inkwell::window {

std::string formatted(double value) { return std::isnan(value) ? "—" : fmt::format("{:.4g}", value); }

std::vector<std::string> statistics_lines(const Statistics& statistics, const ShownUnit& unit) {
  const auto number = [&](double value) { return formatted(static_cast<double>(unit.factor) * value); };
  const std::string ending = unit.name.empty() || unit.name == "1" ? "" : fmt::format(" {}", unit.name);
  const std::string mean = number(statistics.mean), deviation = number(statistics.standard_deviation),
                    rms = number(statistics.root_mean_square), least = number(statistics.minimum),
                    most = number(statistics.maximum);
  return {fmt::format("mean {}{}   rms {}{}   deviation {}{}   {} to {}{}", mean, ending, rms, ending, deviation,
                      ending, least, most, ending),
          fmt::format("mean {}   rms {}   deviation {}   {} to {}{}", mean, rms, deviation, least, most, ending),
          fmt::format("{} ± {}, rms {}, {} to {}{}", mean, deviation, rms, least, most, ending),
          fmt::format("{} ± {}{}", mean, deviation, ending)};
}

}  // namespace inkwell::window
