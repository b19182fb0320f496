// Suggestions for unknown keys.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace inkwell::arms {

/// Returns advice for an unknown key. The advice is the known key of the same quantity ("lengths are in metres:
/// link_2_m"), the nearest known key ("did you mean ...?"), or the list of known keys.
std::string advice_for(std::string_view key, std::span<const std::string_view> known);

}  // namespace inkwell::arms
