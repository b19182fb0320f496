// Sections about undetected faults.
#pragma once

#include <vector>

#include "host/lab/campaign/groups.hpp"
#include "host/lab/campaign/section.hpp"

namespace inkwell::campaign {

struct Undetected {
  Section section;              ///< findings: faults
  std::size_t also_in_use = 0;  ///< faults that continued use did not reveal either
};

/// Lists the undetected faults after which the bridges stayed on.
Undetected undetected_with_force(const Groups& groups, const std::vector<CaseFault>& faults);
/// Lists the undetected faults after which the bridges switched off. Findings: faults.
Section off_without_report(const Groups& groups, const std::vector<CaseFault>& faults);
/// Findings: faults.
Section undetected_without_force(const Groups& groups, const std::vector<CaseFault>& faults);

}  // namespace inkwell::campaign
