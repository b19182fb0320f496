#include "host/lab/campaign/page_situations.hpp"

#include <fmt/format.h>

#include "host/lab/campaign/run.hpp"

#include "host/lab/campaign/page_plots.hpp"

namespace inkwell::campaign {
namespace {

std::string row(const std::string& fault, const Summary& s) {
  std::string detected = s.detected_as.empty() ? "-" : s.detected_as;
  if (s.detected > 0 && s.detected < s.cases) detected += fmt::format(" ({} of {})", s.detected, s.cases);
  std::string recovery = s.recovery;
  constexpr double notable_m = 0.002;  // the newest pose of a fast probe is one millisecond old
  if (s.position_error_m > notable_m) recovery += fmt::format("; position error {:.0f} mm", 1e3 * s.position_error_m);
  return fmt::format("| `{}` | {} | {} | {:.2f} | {:.1f} | {:.1f} | {} |\n", fault, detected, off_text(s),
                     s.peak_force_N, 1e3 * s.energy_J, 1e3 * s.travel_m, recovery);
}

}  // namespace

std::string off_text(const Summary& s) {
  if (s.were_on == 0) return "already off";
  if (s.went_off == 0) return "stayed on";
  const double periods = s.off_after_s / control_period_s;
  std::string text = periods < 100 ? fmt::format("{:.1f}", periods) : fmt::format("{:.0f}", periods);
  if (s.went_off < s.were_on) text += fmt::format("; {} of {} stayed on", s.were_on - s.went_off, s.were_on);
  return text;
}

std::string columns() {
  return fmt::format(R"(
Each row shows the worst values of its cases. The row `none` shows the values without a fault.

- **Reported as**: the faults that the board reported, and restarts.
- **Bridges off after**: time until no half bridge of an enabled bridge was driven high, in control periods of {:.0f} us.
- **Peak force**, **energy** (delivered to the hand) and **travel**: values of the {} s after the injection. In `motion`,
  the travel is the lag of the probe behind the hand.
- **Recovery**: the action that restored the force at the end, after any continued use. Position errors above 2 mm are added.

For three equivalent parts, the row names the second part, whose motor carries the load at the wall. The row includes the
first and third part, which were tested at one instant in each situation.
)",
                     1e6 * control_period_s, observed_s);
}

Section not_run(std::span<const Result> results) {
  std::string rows;
  std::size_t findings = 0;
  for (const Result& result : results)
    if (!result.error.empty()) {
      ++findings;
      rows += fmt::format("| {} | `{}` {} {} | {} |\n", result.number, result.fault.name(), name_of(result.situation),
                          result.phase, result.error);
    }
  if (rows.empty()) return {};
  return {
      "\n## Cases that could not be run\n\n| case | fault, situation, instant | reason |\n| --- | --- | --- |\n" + rows,
      findings};
}

std::string tables(const Groups& groups, const std::vector<CaseFault>& faults) {
  std::string text;
  for (const CaseSituation situation : situations) {
    text += fmt::format("\n## {}\n\n{}\n\n", name_of(situation), meaning_of(situation));
    text +=
        "| fault | reported as | bridges off after, control periods | peak force, N | energy, mJ | travel, mm | "
        "recovery "
        "|\n| --- | --- | --- | --- | --- | --- | --- |\n";
    for (const CaseFault& fault : faults)
      if (const auto* results = find(groups, fault, situation)) {
        const Summary summary = summarise(*results);
        if (summary.cases > 0) text += row(fault.name(), summary);
      }
  }
  return text;
}

}  // namespace inkwell::campaign
