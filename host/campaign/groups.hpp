// Results by fault and situation.
#pragma once

#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <campaign/cases.hpp>
#include <campaign/result.hpp>

namespace inkwell::campaign {

/// By fault as it is listed, and situation.
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

/// The case without a fault that began alike; null if it was not run.
inline const Result* sound_of(const Groups& groups, CaseSituation situation, unsigned phase) {
  if (const auto* results = find(groups, "none", situation))
    for (const Result& result : *results)
      if (result.error.empty() && result.phase == phase) return &result;
  return nullptr;
}

/// By the hand, and by no fault.
inline bool is_flung(const Result& result) { return result.fault == CaseFault{.deed = Deed::fast_hand}.name(); }
/// What drove the bridges were the self-test's pulses, which are no force.
inline bool is_testing(const Result& result) {
  return result.situation == name_of(CaseSituation::testing) || result.situation == name_of(CaseSituation::starting);
}

}  // namespace inkwell::campaign
