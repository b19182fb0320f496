// Shortens labels to the available width.
#pragma once

#include <functional>
#include <string>
#include <string_view>

namespace inkwell::window {

/// Returns the text if its width is at most `room`. Otherwise returns the longest possible prefix with an ellipsis, or
/// an empty text. `width_of` returns the width of a text. UTF-8 characters of the text are not split.
std::string with_ellipsis(std::string_view text, float room, const std::function<float(std::string_view)>& width_of);

}  // namespace inkwell::window
