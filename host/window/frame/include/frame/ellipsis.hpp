// Labels that do not fit.
#pragma once

#include <functional>
#include <string>
#include <string_view>

namespace inkwell::window {

/// The text, or as much of its begin as fits with an ellipsis behind it; empty if not even that fits. `width_of` tells
/// what a text takes. UTF-8; no character is cut.
std::string with_ellipsis(std::string_view text, float room, const std::function<float(std::string_view)>& width_of);

}  // namespace inkwell::window
