// Results grouped by fault and situation.
#pragma once

#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "host/lab/campaign/cases.hpp"
#include "host/lab/campaign/result.hpp"

namespace inkwell::campaign {

/// The results are grouped by listed fault name and situation.
using Groups = std::map<std::pair<std::string, std::string>, std::vector<Result>>;

inline Groups group(std::span<const Result> results) {
  Groups groups;
  for (const Result& result : results) groups[{listed_name(result.fault), result.situation}].push_back(result);
  return groups;
}

inline const std::vector<Result>* find(const Groups& groups, const std::string& fault, CaseSituation situation) {
  const auto found = groups.find({fault, std::string(name_of(situation))});
  return found == groups.end() ? nullptr : &found->second;
}

/// The fault-free case with the same situation and phase; null if it was not run.
inline const Result* fault_free(const Groups& groups, CaseSituation situation, unsigned phase) {
  if (const auto* results = find(groups, "none", situation))
    for (const Result& result : *results)
      if (result.error.empty() && result.phase == phase) return &result;
  return nullptr;
}

/// Whether the hand flings the arm, without an injected fault.
inline bool is_flung(const Result& result) { return result.fault == CaseFault{.deed = Deed::fast_hand}.name(); }
/// Whether the bridges were driven only by self-test pulses, which do not count as force.
inline bool is_testing(const Result& result) {
  return result.situation == name_of(CaseSituation::testing) || result.situation == name_of(CaseSituation::starting);
}

}  // namespace inkwell::campaign
