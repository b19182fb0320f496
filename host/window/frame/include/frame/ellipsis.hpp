// Shortens labels that do not fit.
#pragma once

#include <functional>
#include <string>
#include <string_view>

namespace inkwell::window {

/// Returns the text, or its longest prefix that fits with an ellipsis; empty if no prefix fits. `width_of` returns the
/// width of a text. UTF-8 characters of the text are not split.
std::string with_ellipsis(std::string_view text, float room, const std::function<float(std::string_view)>& width_of);

}  // namespace inkwell::window
