// What the page says of faults that were not noticed.
#pragma once

#include <string>
#include <vector>

#include "groups.hpp"

namespace inkwell::campaign {

/// With the force on: the bridges stayed on.
std::string unnoticed(const Groups& groups, const std::vector<CaseFault>& faults);
/// With the force on: the bridges went off, and nobody was told.
std::string off_but_not_told(const Groups& groups, const std::vector<CaseFault>& faults);
std::string unnoticed_without_force(const Groups& groups, const std::vector<CaseFault>& faults);

}  // namespace inkwell::campaign
