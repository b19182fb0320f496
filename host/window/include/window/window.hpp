// Entry point of the companion's window.
#pragma once

#include <window/window_options.hpp>

namespace inkwell::window {

/// Opens the window and runs it until it is closed. Returns the exit code of the process. An error is printed to
/// standard error and gives the code 1: no display, no OpenGL 3.3, or a screenshot that could not be written.
int run_window(const WindowOptions& options);

}  // namespace inkwell::window
