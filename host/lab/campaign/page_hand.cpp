#include "host/lab/campaign/page_hand.hpp"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "host/lab/campaign/page.hpp"
#include "protocol/supervision.hpp"

#include "host/lab/campaign/page_plots.hpp"
#include "host/lab/campaign/page_situations.hpp"

namespace inkwell::campaign {

void AtTheHand::Worst::see(double other, const Result& result) {
  if (where.empty() || other > value)
    *this = {other, fmt::format("`{}` in {}", result.fault.name(), name_of(result.situation))};
}

AtTheHand::AtTheHand(const Groups& groups, const std::vector<CaseFault>& faults) {
  for (const CaseSituation situation : situations) {
    if (!is_active(situation)) continue;
    for (const CaseFault& fault : faults) {
      const auto* results = fault.deed == Deed::fast_hand ? nullptr : find(groups, fault, situation);
      if (results == nullptr) continue;
      for (const Result& r : *results) {
        if (!r.error.empty()) continue;
        force_N_.see(r.peak_force_N, r);
        if (fault.is_fault_free()) continue;
        if (const Result* const healthy = fault_free(groups, situation, r.phase))
          more_J_.see(r.energy_J - healthy->energy_J, r);
        else if (not_compared_.empty() || not_compared_.back() != name_of(situation))
          not_compared_.push_back(name_of(situation));
      }
    }
  }
}

std::string AtTheHand::force_text() const {
  return force_N_.where.empty() ? "unknown" : fmt::format("{:.2f} N ({})", force_N_.value, force_N_.where);
}

std::string AtTheHand::energy_text() const {
  if (more_J_.where.empty()) return "unknown";
  return more_J_.value <= 0 ? "none" : fmt::format("{:.1f} mJ ({})", 1e3 * more_J_.value, more_J_.where);
}

std::string AtTheHand::section() const {
  std::string text = "\n## Largest values\n\n";
  if (force_N_.where.empty())
    return text + "No case with the force on was run, so force and energy at the hand are unknown.\n";
  text += fmt::format("With the force on, the largest force on the hand was {}.", force_text());
  if (!more_J_.where.empty())
    text += fmt::format(" Compared with the fault-free case in the same situation at the same instant, {}.",
                        more_J_.value <= 0 ? "no case delivered extra energy"
                                           : fmt::format("the largest extra energy was {}", energy_text()));
  if (!not_compared_.empty())
    text += fmt::format(
        " The extra energy is unknown for some cases in {}, because the case `none` was not run at each instant.",
        fmt::join(not_compared_, ", "));
  return text + "\n";
}

Section above_limit(const Groups& groups, const std::vector<CaseFault>& faults) {
  std::string rows;
  std::size_t findings = 0;
  for (const CaseFault& fault : faults)
    for (const CaseSituation situation : situations) {
      const auto* results = find(groups, fault, situation);
      if (results == nullptr || fault.deed == Deed::fast_hand || !is_active(situation)) continue;
      const Summary s = summarise(*results);
      const double tolerated_N = tolerated_part_of_limit * force_limit_N(*results);
      for (const Result& r : *results)
        if (r.peak_force_in_use_N.value_or(0.0) > tolerated_N) {
          ++findings;
          rows += fmt::format("| `{}` | {}, continued use | {:.1f} | - | - | {} | - |\n", r.fault.name(),
                              name_of(situation), *r.peak_force_in_use_N,
                              r.noticed_in_use_as.by == NoticedInUse::By::nothing ? "-" : name_of(r.noticed_in_use_as));
        }
      if (s.peak_force_N <= tolerated_N) continue;
      ++findings;
      rows += fmt::format("| `{}` | {} | {:.1f} | {:.0f} | {:.0f} | {} | {} |\n", fault.name(), name_of(situation),
                          s.peak_force_N, 1e3 * s.energy_J, 1e3 * s.travel_m,
                          s.detected_as.empty() ? "-" : s.detected_as, off_text(s));
    }
  const std::string heading = "\n## Above the force limit\n\n";
  const double percent = 100 * tolerated_part_of_limit;
  if (rows.empty())
    return {heading + fmt::format("With the force on, no case exceeded {:.0f} % of the force limit.\n", percent)};
  return {heading + fmt::format("These cases with the force on exceeded {:.0f} % of the force limit.\n\n| fault | "
                                "situation | peak force, N | energy, mJ | travel, mm | reported "
                                "as | bridges off after, control periods |\n"
                                "| --- | --- | --- | --- | --- | --- | --- |\n{}",
                                percent, rows),
          findings};
}

Section switched_on(std::span<const Result> results) {
  std::string rows;
  std::size_t findings = 0;
  for (const Result& result : results) {
    if (!result.error.empty() || !result.bridges_went_on) continue;
    ++findings;
    rows += fmt::format("| {} | `{}` {} {} | {:.2f} | {:.1f} | {:.1f} | {} |\n", result.number, result.fault.name(),
                        name_of(result.situation), result.phase, result.peak_force_N, 1e3 * result.energy_J,
                        1e3 * result.travel_m, fault_text(result).empty() ? "-" : fault_text(result));
  }
  const std::string heading = "\n## Bridges that switched on unexpectedly\n\n";
  if (rows.empty()) return {heading + "No bridge switched on unexpectedly after the injection.\n"};
  return {heading +
              "In these cases the bridges were off, but a half bridge was driven high after the injection.\n\n"
              "| case | fault, situation, instant | peak force, N | energy, mJ | travel, mm | reported as |\n"
              "| --- | --- | --- | --- | --- | --- |\n" +
              rows,
          findings};
}

std::string fast_hand(std::span<const Result> results) {
  double with_N = 0, without_N = 0;
  unsigned with = 0, without = 0, reported = 0;
  for (const Result& result : results) {
    if (!result.error.empty() || !is_flung(result)) continue;
    if (!result.bridges_were_on || is_testing(result)) {
      ++without;
      without_N = std::max(without_N, result.peak_force_N);
    } else {
      ++with;
      with_N = std::max(with_N, result.peak_force_N);
      reported += result.detected_as == protocol::Fault::over_speed;
    }
  }
  std::string text = fmt::format(
      "\n## Fast hand\n\nThe case `fast_hand` contains no defect. The hand moves the arm {:.0f} mm along x within {} "
      "s, "
      "which exceeds the speed limit of the force.",
      1e3 * fling_m, fling_s);
  if (without > 0)
    text +=
        fmt::format(" Without a force from the motors, this motion requires up to {:.2f} N at the hand.", without_N);
  if (with > 0)
    text += fmt::format(
        " With the force on, the force on the hand was up to {:.2f} N, and `{}` was reported in {} of {} cases.",
        with_N, protocol::info(protocol::Fault::over_speed).name, reported, with);
  return text + (with + without == 0 ? " No such case was run.\n" : "\n");
}

}  // namespace inkwell::campaign
