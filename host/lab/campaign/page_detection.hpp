// Sections about reports: a second fault, the boot loader, and faults that no case reported.
#pragma once

#include <span>

#include "host/lab/campaign/result.hpp"

#include "host/lab/campaign/section.hpp"

namespace inkwell::campaign {

/// State of the earlier fault. Findings: cases that lost the report of the earlier fault.
Section after_another(std::span<const Result> results);
/// Findings: cases that did not reach the boot loader.
Section missed_boot_loader(std::span<const Result> results);
/// Findings: monitored faults that were reported in none of these cases.
Section never_reported(std::span<const Result> results);

}  // namespace inkwell::campaign
