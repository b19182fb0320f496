// Parts of the page: reports after another fault, reports for a fast hand, and faults that are never reported.
#pragma once

#include <span>
#include <string>

#include "groups.hpp"

namespace inkwell::campaign {

/// State of the earlier fault, and the transition to the boot loader.
std::string after_another(std::span<const Result> results);
/// Force on the hand that flings the arm, with the force on and off.
std::string fast_hand(std::span<const Result> results);
/// Monitored faults that were reported in none of these cases.
std::string told_by_none(std::span<const Result> results);

}  // namespace inkwell::campaign
