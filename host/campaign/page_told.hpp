// Parts of the page: reports after another fault, reports for a fast hand, and faults that are never reported.
#pragma once

#include <span>
#include <string>

#include "groups.hpp"

namespace inkwell::campaign {

/// Section about the reports after an earlier fault, and about the transition to the boot loader.
std::string after_another(std::span<const Result> results);
/// Force on the hand that flings the arm, with the force on and off.
std::string fast_hand(std::span<const Result> results);
/// Monitored faults that no case reported.
std::string unreported_faults(std::span<const Result> results);

}  // namespace inkwell::campaign
