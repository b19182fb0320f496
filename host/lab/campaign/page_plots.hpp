// Plots of the campaign page.
#pragma once

#include <span>
#include <string>

#include "host/lab/campaign/result.hpp"
#include "protocol/reports.hpp"

namespace inkwell::campaign {

/// Time unit of tables and plots.
inline constexpr double control_period_s = 1.0 / protocol::servo_rate_Hz;

/// Returns the force limit of the cases, or 0 if no case could be run.
double force_limit_N(std::span<const Result> results);

std::string off_plot(std::span<const Result> results);
std::string force_plot(std::span<const Result> results);

}  // namespace inkwell::campaign
