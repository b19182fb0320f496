#include <campaign/page.hpp>

#include <algorithm>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <campaign/run.hpp>
#include <device/error.hpp>
#include <recording/write_text.hpp>

#include "groups.hpp"
#include "page_plots.hpp"
#include "page_told.hpp"
#include "page_unnoticed.hpp"

namespace inkwell::campaign {
namespace {

constexpr double allowed_part_of_limit = 1.05;

std::string off_text(const Summary& s) {
  if (s.were_on == 0) return "were off";
  if (s.went_off == 0) return "stayed on";
  const double periods = s.off_after_s / control_period_s;
  std::string text = periods < 100 ? fmt::format("{:.1f}", periods) : fmt::format("{:.0f}", periods);
  if (s.went_off < s.were_on) text += fmt::format("; {} of {} stayed on", s.were_on - s.went_off, s.were_on);
  return text;
}

std::string row(const std::string& fault, const Summary& s) {
  std::string detected = s.detected_as.empty() ? "-" : s.detected_as;
  if (s.detected > 0 && s.detected < s.cases) detected += fmt::format(" ({} of {})", s.detected, s.cases);
  std::string recovery = s.recovery;
  constexpr double notable_m = 0.002;  // the newest pose of a fast probe is one millisecond old
  if (s.position_error_m > notable_m) recovery += fmt::format("; position {:.0f} mm off", 1e3 * s.position_error_m);
  return fmt::format("| `{}` | {} | {} | {:.2f} | {:.1f} | {:.1f} | {} |\n", fault, detected, off_text(s),
                     s.peak_force_N, 1e3 * s.energy_J, 1e3 * s.travel_m, recovery);
}

std::string tables(const Groups& groups, const std::vector<CaseFault>& faults) {
  std::string text;
  for (const CaseSituation situation : situations) {
    text += fmt::format("\n## {}\n\n{}\n\n", name_of(situation), meaning_of(situation));
    text +=
        "| fault | detected as | bridges off, control periods | peak force, N | energy, mJ | travel, mm | recovered by "
        "|\n| --- | --- | --- | --- | --- | --- | --- |\n";
    for (const CaseFault& fault : faults)
      if (const auto* results = find(groups, fault.name(), situation)) {
        const Summary summary = summarise(*results);
        if (summary.cases > 0) text += row(fault.name(), summary);
      }
  }
  return text;
}

/// Worst values of all cases with the force on. The extra energy is listed only where a fault-free run exists for
/// comparison.
std::string at_the_hand(const Groups& groups, const std::vector<CaseFault>& faults) {
  struct Worst {
    double value = 0.0;
    std::string where;
    void see(double other, const Result& result) {
      if (where.empty() || other > value) *this = {other, fmt::format("`{}` in {}", result.fault, result.situation)};
    }
  } force_N, more_J;
  std::vector<std::string_view> not_compared;
  for (const CaseSituation situation : situations) {
    if (!is_active(situation)) continue;
    for (const CaseFault& fault : faults) {
      const auto* results = fault.deed == Deed::fast_hand ? nullptr : find(groups, fault.name(), situation);
      if (results == nullptr) continue;
      for (const Result& r : *results) {
        if (!r.error.empty()) continue;
        force_N.see(r.peak_force_N, r);
        if (fault.is_fault_free()) continue;
        if (const Result* const fault_free = fault_free_case(groups, situation, r.phase))
          more_J.see(r.energy_J - fault_free->energy_J, r);
        else if (not_compared.empty() || not_compared.back() != name_of(situation))
          not_compared.push_back(name_of(situation));
      }
    }
  }
  std::string text = "\n## At the hand\n\n";
  if (force_N.where.empty())
    return text + "No case with the force on was run, so what the hand would have felt cannot be told.\n";
  text +=
      fmt::format("With the force on the hand felt at most {:.2f} N in that time ({})", force_N.value, force_N.where);
  if (more_J.where.empty())
    text += ".";
  else if (more_J.value <= 0)
    text += ", and got no more energy than without a fault in the same situation at the same instant.";
  else
    text += fmt::format(
        ", and got at most {:.1f} mJ more than without a fault in the same situation at the same instant ({}).",
        1e3 * more_J.value, more_J.where);
  if (!not_compared.empty())
    text += fmt::format(
        " How much more energy it got than without a fault cannot be told of {}: the case `none` was not run at each "
        "of its instants.",
        fmt::join(not_compared, ", "));
  return text + "\n";
}

std::string above_limit(const Groups& groups, const std::vector<CaseFault>& faults) {
  std::string rows;
  for (const CaseFault& fault : faults)
    for (const CaseSituation situation : situations) {
      const auto* results = find(groups, fault.name(), situation);
      if (results == nullptr || fault.deed == Deed::fast_hand || !is_active(situation)) continue;
      const Summary s = summarise(*results);
      const double allowed_N = allowed_part_of_limit * force_limit_N(*results);
      for (const Result& r : *results)
        if (r.peak_force_in_use_N.value_or(0.0) > allowed_N)
          rows += fmt::format("| `{}` | {}, used on | {:.1f} | - | - | {} | - |\n", r.fault, name_of(situation),
                              *r.peak_force_in_use_N, r.noticed_in_use_as.empty() ? "-" : r.noticed_in_use_as);
      if (s.peak_force_N <= allowed_N) continue;
      rows += fmt::format("| `{}` | {} | {:.1f} | {:.0f} | {:.0f} | {} | {} |\n", fault.name(), name_of(situation),
                          s.peak_force_N, 1e3 * s.energy_J, 1e3 * s.travel_m,
                          s.detected_as.empty() ? "-" : s.detected_as, off_text(s));
    }
  const std::string_view heading =
      "\n## Above the force limit\n\nWith the force on, cases in which the hand felt more than the force limit and a "
      "twentieth of it";
  if (rows.empty()) return fmt::format("{}: none.\n", heading);
  return fmt::format(
      "{}.\n\n| fault | situation | peak force, N | energy, mJ | travel, mm | detected as | bridges off, control "
      "periods |\n| --- | --- | --- | --- | --- | --- | --- |\n{}",
      heading, rows);
}

std::string went_on(std::span<const Result> results) {
  std::string text;
  for (const Result& result : results)
    if (result.error.empty() && result.bridges_went_on)
      text += fmt::format("| {} | `{}` {} {} | {:.2f} | {:.1f} | {:.1f} | {} |\n", result.number, result.fault,
                          result.situation, result.phase, result.peak_force_N, 1e3 * result.energy_J,
                          1e3 * result.travel_m, fault_text(result).empty() ? "-" : fault_text(result));
  if (text.empty()) return text;
  return "\n## Went on by itself\n\nThe bridges were off, and a leg was at the supply after the fault came.\n\n"
         "| case | what | peak force, N | energy, mJ | travel, mm | detected as |\n"
         "| --- | --- | --- | --- | --- | --- |\n" +
         text;
}

std::string not_run(std::span<const Result> results) {
  std::string text;
  for (const Result& result : results)
    if (!result.error.empty())
      text += fmt::format("| {} | `{}` {} {} | {} |\n", result.number, result.fault, result.situation, result.phase,
                          result.error);
  if (text.empty()) return text;
  return "\n## Could not be run\n\n| case | what | why |\n| --- | --- | --- |\n" + text;
}

std::string recovery_of(const Result& r) {
  if (!r.fault_on_healing.empty())
    return fmt::format("{} of the {} that healing brought", r.recovery, r.fault_on_healing);
  if (!r.noticed_in_use_as.empty()) return fmt::format("{} of the {} in use", r.recovery, r.noticed_in_use_as);
  return r.recovery;
}

void add(std::set<std::string>& names, const std::string& name) {
  if (!name.empty()) names.insert(name);
}

}  // namespace

Summary summarise(std::span<const Result> results) {
  Summary s;
  std::set<std::string> faults, recoveries;
  for (const Result& r : results) {
    if (!r.error.empty()) continue;
    ++s.cases;
    s.detected += is_detected(r);
    add(faults, fault_text(r));
    add(recoveries, recovery_of(r));
    s.were_on += r.bridges_were_on;
    s.went_off += r.off_after_s.has_value();
    s.off_after_s = std::max(s.off_after_s, r.off_after_s.value_or(0.0));
    s.peak_force_N = std::max(s.peak_force_N, r.peak_force_N);
    s.energy_J = std::max(s.energy_J, r.energy_J);
    s.travel_m = std::max(s.travel_m, r.travel_m);
    s.position_error_m = std::max(s.position_error_m, r.position_error_m.value_or(0.0));
  }
  s.detected_as = fmt::format("{}", fmt::join(faults, "; "));
  s.recovery = fmt::format("{}", fmt::join(recoveries, "; "));
  return s;
}

void write_page(std::span<const Result> results, const std::filesystem::path& page) {
  if (results.empty()) throw device::Error("There is no result to make a page of. Run cases first.");
  const auto faults = case_faults();
  const auto groups = group(results);
  const std::string stem = page.stem().string();
  constexpr const char* head = R"(# What faults do: simulation

Made by `inkwell campaign`; do not edit. The firmware that is flashed runs on the virtual board, whose brown-out level
is 3, as `inkwell flash` sets it. Each fault is put in at {} random instants while the arm is unreferenced, ready, at
rest, pressed into a stiff wall and in fast motion, while the force rises, is held back by its limit and falls, pressed
into that wall, while the board tests itself, after another fault, on the way to the boot loader, and, once before and
twice after the power has come, while the board starts.
{} of {} cases were run. A row tells the worst of its cases. The force limit is {:.1f} N; the row `none` is what the
hand feels without a fault. Peak force, energy given to the hand and travel (in motion: how far the probe lags behind
the hand) are of the {} s after the fault came, recovery and position of the end, after the use that "Not noticed" tells
of. Of what there are three of, the tables name the second, whose motor bears the load at the wall; the first and the
third were tried at one instant in each situation, in the same row. "bridges off" is when no bridge that is on had a leg
at the supply any more, in control periods of {:.0f} us.

![until the bridges were off]({}-off.svg)
![peak force]({}-force.svg)
)";
  std::string text = fmt::format(head, phases, results.size(), all_cases().size(), force_limit_N(results), observed_s,
                                 1e6 * control_period_s, stem, stem);
  text += went_on(results) + at_the_hand(groups, faults) + above_limit(groups, faults) + fast_hand(results) +
          unnoticed(groups, faults) + off_without_report(groups, faults) + unnoticed_without_force(groups, faults) +
          after_another(results) + unreported_faults(results) + not_run(results) + tables(groups, faults);
  recording::write_text(page, text);
  recording::write_text(page.parent_path() / (stem + "-off.svg"), off_plot(results));
  recording::write_text(page.parent_path() / (stem + "-force.svg"), force_plot(results));
}

}  // namespace inkwell::campaign
