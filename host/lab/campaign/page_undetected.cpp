#include "host/lab/campaign/page_undetected.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "host/lab/campaign/run.hpp"

#include "host/lab/campaign/reasons.hpp"

namespace inkwell::campaign {
namespace {

/// Counts the detections during continued use.
class InUse {
 public:
  /// `healthy` is the fault-free case with the same start, or null.
  void see(const Result& result, const Result* healthy) {
    if (!result.error.empty()) return;
    if (!result.peak_force_in_use_N) {
      ++not_used_;
      return;
    }
    ++used_;
    peak_N_ = std::max(peak_N_, *result.peak_force_in_use_N);
    if (!result.noticed_in_use_s) {
      compare(result, healthy);
      return;
    }
    ++noticed_;
    names_.insert(name_of(result.noticed_in_use_as));
    after_s_ = std::max(after_s_, *result.noticed_in_use_s);
  }
  unsigned used() const { return used_; }
  unsigned noticed() const { return noticed_; }
  std::string peak_text() const { return used_ == 0 ? "-" : fmt::format("{:.2f}", peak_N_); }
  std::string energy_text() const {
    if (!more_J_) return "-";
    return *more_J_ <= 0 ? "none" : fmt::format("{:.1f}", 1e3 * *more_J_);
  }
  std::string text() const {
    if (used_ == 0) return "without use";
    const std::string left_out = not_used_ == 0 ? "" : fmt::format("; {} without use", not_used_);
    if (noticed_ == 0) return "-" + left_out;
    return fmt::format("{}{}, within {:.2f} s{}", fmt::join(names_, "; "),
                       noticed_ < used_ ? fmt::format(" ({} of {})", noticed_, used_) : "", after_s_, left_out);
  }

 private:
  /// Ignores cases in which the use stopped early.
  void compare(const Result& result, const Result* healthy) {
    if (healthy == nullptr || healthy->noticed_in_use_s || !result.energy_in_use_J || !healthy->energy_in_use_J) return;
    const double more_J = *result.energy_in_use_J - *healthy->energy_in_use_J;
    more_J_ = std::max(more_J_.value_or(more_J), more_J);
  }

  unsigned used_ = 0, not_used_ = 0, noticed_ = 0;
  double peak_N_ = 0, after_s_ = 0;
  std::optional<double> more_J_;
  std::set<std::string_view> names_;
};

InUse healthy_in_use(const Groups& groups) {
  InUse healthy;
  for (const CaseSituation situation : situations)
    if (const auto* results = find(groups, CaseFault{}, situation))
      for (const Result& result : *results) healthy.see(result, &result);
  return healthy;
}

/// Returns the situation with the number of cases and the affected parts. Returns an empty text if no completed case
/// satisfies `counts`.
std::string situation_with(const Groups& groups, const CaseFault& fault, CaseSituation situation,
                           bool (*counts)(CaseSituation, const Result&)) {
  const auto* results = find(groups, fault, situation);
  if (results == nullptr) return "";
  const auto run = std::ranges::count_if(*results, [](const Result& r) { return r.error.empty(); });
  const auto such =
      std::ranges::count_if(*results, [&](const Result& r) { return r.error.empty() && counts(situation, r); });
  if (such == 0) return "";
  if (such == run) return std::string(name_of(situation));
  std::string at;
  if (is_of_three(fault)) {
    std::vector<unsigned> numbers;
    for (const unsigned number : {1u, 2u, 3u})
      if (std::ranges::any_of(*results, [&](const Result& r) {
            return r.error.empty() && r.fault == at_another(fault, number) && counts(situation, r);
          }))
        numbers.push_back(number);
    if (numbers.size() < 3) at = fmt::format(", at {}", fmt::join(numbers, " and "));
  }
  return fmt::format("{} ({} of {}{})", name_of(situation), such, run, at);
}

void add(std::string& where, const std::string& situation) {
  if (!where.empty() && !situation.empty()) where += ", ";
  where += situation;
}

/// Returns the situations in which a case satisfies `counts`.
std::string situations_with(const Groups& groups, const CaseFault& fault,
                            bool (*counts)(CaseSituation, const Result&)) {
  std::string where;
  for (const CaseSituation situation : situations) add(where, situation_with(groups, fault, situation, counts));
  return where;
}

bool stayed_on_unreported(CaseSituation situation, const Result& result) {
  return is_active(situation) && is_unnoticed(result);
}

bool went_off_unreported(CaseSituation situation, const Result& result) {
  return is_active(situation) && !is_detected(result) && result.off_after_s;
}

bool was_off_unreported(CaseSituation situation, const Result& result) {
  return !is_active(situation) && !is_detected(result);
}

/// Returns the faults that were reported only after their causes were removed.
std::string reported_later(const Groups& groups, const CaseFault& fault) {
  std::set<std::string_view> names;
  for (const CaseSituation situation : situations)
    if (const auto* results = find(groups, fault, situation))
      for (const Result& result : *results)
        if (result.error.empty() && went_off_unreported(situation, result) &&
            result.fault_on_healing != protocol::Fault::none)
          names.insert(name_of_reported(result.fault_on_healing));
  return names.empty() ? "-" : fmt::format("{}", fmt::join(names, "; "));
}

}  // namespace

Undetected undetected_with_force(const Groups& groups, const std::vector<CaseFault>& faults) {
  std::string rows;
  std::size_t findings = 0, also_in_use = 0;
  for (const CaseFault& fault : faults) {
    if (fault.is_fault_free()) continue;
    const std::string where = situations_with(groups, fault, stayed_on_unreported);
    if (where.empty()) continue;
    InUse in_use;
    for (const CaseSituation situation : situations)
      if (const auto* results = find(groups, fault, situation))
        for (const Result& result : *results)
          if (stayed_on_unreported(situation, result)) in_use.see(result, fault_free(groups, situation, result.phase));
    ++findings;
    also_in_use += in_use.used() > 0 && in_use.noticed() == 0;
    rows += fmt::format("| `{}` | {} | {} | {} | {} | {} |\n", fault.name(), where, in_use.text(), in_use.peak_text(),
                        in_use.energy_text(), reason_with_force(fault));
  }
  std::string text = "\n## Undetected with the force on\n\n";
  if (rows.empty()) return {{text + "No fault with the force on was undetected with the bridges still on.\n"}};
  text += fmt::format(
      "In these situations with the force on, the bridges stayed on and no fault was reported. The use of the arm then "
      "continued: the motion of the situation lasted for another {} s. After this, the hand pressed {} times into the "
      "front wall and into the side wall with the force limit. Finally it swung {} times.\n\n"
      "\"Reported during use\" contains the reports during this use and the longest time until a report. \"Extra "
      "energy\" is the additional energy that the hand received, compared with the same use of a healthy arm. It is "
      "listed only for cases that were undetected during use.",
      goes_on_s, use_presses, use_swings);
  if (const InUse healthy = healthy_in_use(groups); healthy.used() > 0)
    text += fmt::format(
        " Without a fault, the largest force during use was {} N, and a fault was reported in {} of {} cases.",
        healthy.peak_text(), healthy.noticed(), healthy.used());
  text +=
      "\n\n| fault | situations | reported during use | peak force during use, N | extra energy during use, mJ | "
      "reason "
      "|\n| --- | --- | --- | --- | --- | --- |\n";
  return {{text + rows, findings}, also_in_use};
}

Section off_without_report(const Groups& groups, const std::vector<CaseFault>& faults) {
  std::string rows;
  std::size_t findings = 0;
  for (const CaseFault& fault : faults) {
    if (fault.is_fault_free()) continue;
    std::map<std::string_view, std::string> where_by_reason;
    for (const CaseSituation situation : situations)
      if (const std::string where = situation_with(groups, fault, situation, went_off_unreported); !where.empty())
        add(where_by_reason[reason_of_silence(fault, situation)], where);
    findings += !where_by_reason.empty();
    for (const auto& [reason, where] : where_by_reason)
      rows += fmt::format("| `{}` | {} | {} | {} |\n", fault.name(), where, reported_later(groups, fault), reason);
  }
  const std::string_view heading = "\n## Bridges off without a report\n\n";
  if (rows.empty())
    return {fmt::format("{}With the force on, a fault was reported whenever the bridges switched off.\n", heading)};
  return {
      fmt::format("{}In these situations with the force on, the bridges switched off, but no fault was reported. The "
                  "third column contains reports after the cause was removed.\n\n"
                  "| fault | situations | later report | reason |\n| --- | --- | --- | --- |\n{}",
                  heading, rows),
      findings};
}

Section undetected_without_force(const Groups& groups, const std::vector<CaseFault>& faults) {
  // Each row contains all faults with the same reason.
  struct Row {
    std::string_view reason;
    std::string where;
    std::vector<std::string> faults;
  };
  std::vector<Row> rows;
  std::size_t findings = 0;
  for (const CaseFault& fault : faults) {
    if (fault.is_fault_free()) continue;
    std::map<std::string_view, std::string> where_by_reason;
    for (const CaseSituation situation : situations)
      if (const std::string where = situation_with(groups, fault, situation, was_off_unreported); !where.empty())
        add(where_by_reason[reason_without_force(fault, situation)], where);
    findings += !where_by_reason.empty();
    for (const auto& [reason, where] : where_by_reason) {
      auto row = std::ranges::find_if(
          rows, [&, &reason = reason, &where = where](const Row& r) { return r.reason == reason && r.where == where; });
      if (row == rows.end()) row = rows.insert(row, {reason, where, {}});
      row->faults.push_back(fmt::format("`{}`", fault.name()));
    }
  }
  std::string text = "\n## Undetected without force\n\n";
  if (rows.empty()) return {text + "No fault without force was undetected.\n"};
  text +=
      "In these situations without force, no fault was reported.\n\n| faults | situations | reason |\n"
      "| --- | --- | --- |\n";
  for (const Row& row : rows)
    text += fmt::format("| {} | {} | {} |\n", fmt::join(row.faults, ", "), row.where, row.reason);
  return {text, findings};
}

}  // namespace inkwell::campaign
