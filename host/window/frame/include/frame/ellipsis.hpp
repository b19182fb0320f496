// Shortens labels that do not fit.
#pragma once

#include <functional>
#include <string>
#include <string_view>

namespace inkwell::window {

/// The text, or the longest beginning that fits with an ellipsis; empty if not even that fits. `width_of` returns the
/// width of a text. The text is UTF-8, and no character is split.
std::string with_ellipsis(std::string_view text, float room, const std::function<float(std::string_view)>& width_of);

}  // namespace inkwell::window
