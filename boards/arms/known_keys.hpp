// Finds what was meant by a key that no section knows.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace inkwell::arms {

/// Advice for an unknown key: the known one of the same quantity in its own unit ("lengths are in metres:
/// link_2_m"), the nearest known one ("did you mean ...?"), or the known ones if nothing is near.
std::string advice_for(std::string_view key, std::span<const std::string_view> known);

}  // namespace inkwell::arms
