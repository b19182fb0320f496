// Suggestions for unknown keys.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace inkwell::arms {

/// Returns advice for an unknown key. The advice corrects the unit ("lengths are in metres: link_2_m"), suggests the
/// nearest key ("did you mean ...?"), or lists the known keys.
std::string advice_for(std::string_view key, std::span<const std::string_view> known);

}  // namespace inkwell::arms
