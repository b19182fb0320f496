// Sections of the page about fault reports.
#pragma once

#include <span>

#include "host/lab/campaign/result.hpp"

#include "host/lab/campaign/section.hpp"

namespace inkwell::campaign {

/// The findings are the cases that lost the report of the earlier fault.
Section after_another(std::span<const Result> results);
/// The findings are the cases that did not reach the boot loader.
Section missed_boot_loader(std::span<const Result> results);
/// The findings are the monitored faults that no case reported.
Section never_reported(std::span<const Result> results);

}  // namespace inkwell::campaign
