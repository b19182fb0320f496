// The companion's window: one function that opens it and returns when it is closed.
#pragma once

#include <window/window_options.hpp>

namespace inkwell::window {

/// Opens the window and runs it until it is closed. Returns the process' exit code: 0, or 1 after a sentence
/// on standard error (no display, no OpenGL 3.3, a screenshot that could not be written).
int run_window(const WindowOptions& options);

}  // namespace inkwell::window
