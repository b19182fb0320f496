// Results grouped by fault and situation.
#pragma once

#include <map>
#include <span>
#include <utility>
#include <vector>

#include "host/lab/campaign/cases.hpp"
#include "host/lab/campaign/result.hpp"

namespace inkwell::campaign {

using Groups = std::map<std::pair<CaseFault, CaseSituation>, std::vector<Result>>;

inline Groups group(std::span<const Result> results) {
  Groups groups;
  for (const Result& result : results) groups[{listed_fault(result.fault), result.situation}].push_back(result);
  return groups;
}

inline const std::vector<Result>* find(const Groups& groups, const CaseFault& fault, CaseSituation situation) {
  const auto found = groups.find({fault, situation});
  return found == groups.end() ? nullptr : &found->second;
}

/// Returns the fault-free case of this situation and phase, or null if the case was not run.
inline const Result* fault_free(const Groups& groups, CaseSituation situation, unsigned phase) {
  if (const auto* results = find(groups, CaseFault{}, situation))
    for (const Result& result : *results)
      if (result.error.empty() && result.phase == phase) return &result;
  return nullptr;
}

inline bool is_flung(const Result& result) { return result.fault.deed == Deed::fast_hand; }
/// Returns true if self-test pulses drive the bridges in this situation.
inline bool is_testing(const Result& result) {
  return result.situation == CaseSituation::testing || result.situation == CaseSituation::starting;
}

}  // namespace inkwell::campaign
