// Writes a table of the worst values for each situation.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "host/lab/campaign/page.hpp"

#include "host/lab/campaign/groups.hpp"
#include "host/lab/campaign/section.hpp"

namespace inkwell::campaign {

/// Returns the time until the bridges were off, or the state of the bridges.
std::string off_text(const Summary& summary);
/// Definitions of the columns.
std::string columns();
/// The findings are the cases that could not be run.
Section not_run(std::span<const Result> results);
std::string tables(const Groups& groups, const std::vector<CaseFault>& faults);

}  // namespace inkwell::campaign
