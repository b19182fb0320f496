// Parts of the page about undetected faults.
#pragma once

#include <string>
#include <vector>

#include "groups.hpp"

namespace inkwell::campaign {

/// Undetected faults with the force on, after which the bridges stayed on.
std::string unnoticed(const Groups& groups, const std::vector<CaseFault>& faults);
/// Undetected faults with the force on, after which the bridges switched off.
std::string off_without_report(const Groups& groups, const std::vector<CaseFault>& faults);
std::string unnoticed_without_force(const Groups& groups, const std::vector<CaseFault>& faults);

}  // namespace inkwell::campaign
