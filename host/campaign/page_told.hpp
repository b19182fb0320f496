// Parts of the page: what is told after another fault, and on the way to the boot loader.
#pragma once

#include <span>
#include <string>

#include "groups.hpp"

namespace inkwell::campaign {

/// What became of the fault that was told before, and of the way to the boot loader.
std::string after_another(std::span<const Result> results);

}  // namespace inkwell::campaign
