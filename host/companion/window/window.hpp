// Entry point of the companion's window.
#pragma once

#include "host/companion/window/window_options.hpp"

namespace inkwell::window {

/// Opens the window and processes events until the window is closed. Returns the exit code of the process. After an
/// error, such as a missing display, the function prints the error to standard error and returns 1.
int run_window(const WindowOptions& options);

}  // namespace inkwell::window
