// Shortens labels to the available width.
#pragma once

#include <functional>
#include <string>
#include <string_view>

namespace inkwell::window {

/// Returns the text if its width is at most `room`. Shortens longer text with an ellipsis, and keeps a number at the
/// end, because several labels may differ only in their numbers. Returns an empty text if not even one character has
/// enough room. `width_of` returns the width of a text. Does not split UTF-8 characters.
std::string with_ellipsis(std::string_view text, float room, const std::function<float(std::string_view)>& width_of);

}  // namespace inkwell::window
