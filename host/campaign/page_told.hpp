// Parts of the page: what is told after another fault, of a fast hand, and what is never told.
#pragma once

#include <span>
#include <string>

#include "groups.hpp"

namespace inkwell::campaign {

/// What became of the fault that was told before, and of the way to the boot loader.
std::string after_another(std::span<const Result> results);
/// What the hand felt that flung the arm, with the force and without.
std::string fast_hand(std::span<const Result> results);
/// The faults that are watched for, but were told in none of these cases.
std::string told_by_none(std::span<const Result> results);

}  // namespace inkwell::campaign
