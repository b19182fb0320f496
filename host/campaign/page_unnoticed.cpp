#include "page_unnoticed.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <campaign/run.hpp>

#include "reasons.hpp"

namespace inkwell::campaign {
namespace {

/// Statistics of the cases with continued use, and of the detections during this use.
class InUse {
 public:
  /// `fault_free`: the fault-free case with the same start, or null.
  void see(const Result& result, const Result* fault_free) {
    if (!result.error.empty()) return;
    if (!result.peak_force_in_use_N) {
      ++not_used_;
      return;
    }
    ++used_;
    peak_N_ = std::max(peak_N_, *result.peak_force_in_use_N);
    if (!result.noticed_in_use_s) {
      compare(result, fault_free);
      return;
    }
    ++noticed_;
    names_.insert(result.noticed_in_use_as);
    after_s_ = std::max(after_s_, *result.noticed_in_use_s);
  }
  unsigned used() const { return used_; }
  unsigned noticed() const { return noticed_; }
  std::string peak_text() const { return used_ == 0 ? "-" : fmt::format("{:.2f}", peak_N_); }
  std::string energy_text() const {
    if (!more_J_) return "-";
    return *more_J_ <= 0 ? "no more" : fmt::format("{:.1f}", 1e3 * *more_J_);
  }
  std::string text() const {
    if (used_ == 0) return "not used";
    const std::string left_out = not_used_ == 0 ? "" : fmt::format("; {} not used", not_used_);
    if (noticed_ == 0) return "-" + left_out;
    return fmt::format("{}{}, {:.2f} s{}", fmt::join(names_, "; "),
                       noticed_ < used_ ? fmt::format(" ({} of {})", noticed_, used_) : "", after_s_, left_out);
  }

 private:
  /// Compares only cases whose continued use was complete, because the other cases had less time.
  void compare(const Result& result, const Result* fault_free) {
    if (fault_free == nullptr || fault_free->noticed_in_use_s || !result.energy_in_use_J ||
        !fault_free->energy_in_use_J)
      return;
    const double more_J = *result.energy_in_use_J - *fault_free->energy_in_use_J;
    more_J_ = std::max(more_J_.value_or(more_J), more_J);
  }

  unsigned used_ = 0, not_used_ = 0, noticed_ = 0;
  double peak_N_ = 0, after_s_ = 0;
  std::optional<double> more_J_;
  std::set<std::string> names_;
};

InUse fault_free_in_use(const Groups& groups) {
  InUse fault_free;
  for (const CaseSituation situation : situations)
    if (const auto* results = find(groups, "none", situation))
      for (const Result& result : *results) fault_free.see(result, &result);
  return fault_free;
}

/// Name of the situation if a completed case satisfies `counts`, otherwise empty. If only some cases satisfy `counts`,
/// their number follows. If not all equivalent parts are affected, the affected parts follow.
std::string situation_with(const Groups& groups, const CaseFault& fault, CaseSituation situation,
                           bool (*counts)(CaseSituation, const Result&)) {
  const auto* results = find(groups, fault.name(), situation);
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
            return r.error.empty() && r.fault == at_another(fault, number).name() && counts(situation, r);
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

/// The situations in which a case satisfies `counts`.
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

/// The faults that were reported only after their causes were removed.
std::string reported_later(const Groups& groups, const CaseFault& fault) {
  std::set<std::string> names;
  for (const CaseSituation situation : situations)
    if (const auto* results = find(groups, fault.name(), situation))
      for (const Result& result : *results)
        if (result.error.empty() && went_off_unreported(situation, result) && !result.fault_on_healing.empty())
          names.insert(result.fault_on_healing);
  return names.empty() ? "-" : fmt::format("{}", fmt::join(names, "; "));
}

}  // namespace

std::string unnoticed(const Groups& groups, const std::vector<CaseFault>& faults) {
  std::string text = fmt::format(
      "\n## Not noticed\n\nWith the force on, in at least one of the cases that were run, the bridges stayed on and no "
      "fault was told. The hand then went on: for {} s as before, then it pressed with the force limit {} times in "
      "turn into the wall in front and the one to the side, and swung {} times. What was told meanwhile stands in the "
      "third column, with the longest time "
      "since it went on; the fourth is what the hand felt at most, the fifth, of those that were not noticed in use "
      "either, how much more energy it got than from a sound arm that was used alike from the same instant on.",
      goes_on_s, use_presses, use_swings);
  if (const InUse fault_free = fault_free_in_use(groups); fault_free.used() > 0)
    text += fmt::format(" Without a fault it felt {} N at most, and a fault was told in {} of {} cases.",
                        fault_free.peak_text(), fault_free.noticed(), fault_free.used());
  text +=
      "\n\n| fault | situations | noticed in use | peak force in use, N | more energy in use, mJ | reason |\n"
      "| --- | --- | --- | --- | --- | --- |\n";
  for (const CaseFault& fault : faults) {
    if (fault.is_fault_free()) continue;
    const std::string where = situations_with(groups, fault, stayed_on_unreported);
    if (where.empty()) continue;
    InUse in_use;
    for (const CaseSituation situation : situations)
      if (const auto* results = find(groups, fault.name(), situation))
        for (const Result& result : *results)
          if (stayed_on_unreported(situation, result))
            in_use.see(result, fault_free_case(groups, situation, result.phase));
    text += fmt::format("| `{}` | {} | {} | {} | {} | {} |\n", fault.name(), where, in_use.text(), in_use.peak_text(),
                        in_use.energy_text(), reason_with_force(fault));
  }
  return text;
}

std::string off_without_report(const Groups& groups, const std::vector<CaseFault>& faults) {
  std::string rows;
  for (const CaseFault& fault : faults) {
    if (fault.is_fault_free()) continue;
    std::map<std::string_view, std::string> where_by_reason;
    for (const CaseSituation situation : situations)
      if (const std::string where = situation_with(groups, fault, situation, went_off_unreported); !where.empty())
        add(where_by_reason[reason_of_silence(fault, situation)], where);
    for (const auto& [reason, where] : where_by_reason)
      rows += fmt::format("| `{}` | {} | {} | {} |\n", fault.name(), where, reported_later(groups, fault), reason);
  }
  const std::string_view heading =
      "\n## Off, but not told\n\nWith the force on, cases in which the bridges went off, but no fault was told";
  if (rows.empty()) return fmt::format("{}: none.\n", heading);
  return fmt::format(
      "{}. The third column has what was told once the cause was gone.\n\n| fault | situations | told later | reason "
      "|\n| --- | --- | --- | --- |\n{}",
      heading, rows);
}

std::string unnoticed_without_force(const Groups& groups, const std::vector<CaseFault>& faults) {
  // The faults are grouped by reason, because many faults have the same reason.
  struct Row {
    std::string_view reason;
    std::string where;
    std::vector<std::string> faults;
  };
  std::vector<Row> rows;
  for (const CaseFault& fault : faults) {
    if (fault.is_fault_free()) continue;
    std::map<std::string_view, std::string> where_by_reason;
    for (const CaseSituation situation : situations)
      if (const std::string where = situation_with(groups, fault, situation, was_off_unreported); !where.empty())
        add(where_by_reason[reason_without_force(fault, situation)], where);
    for (const auto& [reason, where] : where_by_reason) {
      auto row = std::ranges::find_if(
          rows, [&, &reason = reason, &where = where](const Row& r) { return r.reason == reason && r.where == where; });
      if (row == rows.end()) row = rows.insert(row, {reason, where, {}});
      row->faults.push_back(fmt::format("`{}`", fault.name()));
    }
  }
  std::string text = "\n## Not noticed without force\n\nCases without force in which no fault was told";
  if (rows.empty()) return text + ": none.\n";
  text += ".\n\n| faults | situations | reason |\n| --- | --- | --- |\n";
  for (const Row& row : rows)
    text += fmt::format("| {} | {} | {} |\n", fmt::join(row.faults, ", "), row.where, row.reason);
  return text;
}

}  // namespace inkwell::campaign
