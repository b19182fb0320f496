// X11 or Wayland. GLFW before 3.4, as in Debian 12, has X11 alone; window_system.cpp alone asks for its version.
#pragma once

namespace inkwell::window {

/// Starts GLFW on X11 if there is a display, else on Wayland; the other way round if INKWELL_WINDOW_SYSTEM is
/// "wayland". Returns false if no window system could be started. Throws DisplayError if the variable has another
/// value.
bool start_window_system();

/// The name by which a desktop finds the program's entry and icon: that of packaging/inkwell.desktop. Before a window
/// is created.
void set_program_name(const char* name);

/// True if one unit of the screen is one pixel. On Wayland the desktop has already scaled its units.
bool has_pixel_units();

}  // namespace inkwell::window
