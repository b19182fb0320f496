// The page's plots: how soon the bridges were off, and how hard it was for the hand.
#pragma once

#include <span>
#include <string>

#include <campaign/result.hpp>
#include <protocol/reports.hpp>

namespace inkwell::campaign {

/// In which tables and plots count.
inline constexpr double control_period_s = 1.0 / protocol::servo_rate_Hz;

/// The limit that the cases ran with; 0 if none could be run.
double force_limit_N(std::span<const Result> results);

std::string off_plot(std::span<const Result> results);
std::string force_plot(std::span<const Result> results);

}  // namespace inkwell::campaign
