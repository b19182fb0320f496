// What the page says of faults that were not noticed.
#pragma once

#include <string>
#include <vector>

#include "groups.hpp"

namespace inkwell::campaign {

std::string unnoticed(const Groups& groups, const std::vector<CaseFault>& faults);

}  // namespace inkwell::campaign
