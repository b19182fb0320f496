// Selects X11 or Wayland. GLFW before 3.4 (Debian 12) supports only X11, or only Wayland with the package
// libglfw3-wayland. Only window_system.cpp depends on the GLFW version.
#pragma once

namespace inkwell::window {

/// Starts GLFW on X11 if available, otherwise on Wayland. If INKWELL_WINDOW_SYSTEM is "wayland", Wayland has priority.
/// Returns false if no window system could be started. Throws DisplayError if the value of INKWELL_WINDOW_SYSTEM is
/// invalid.
bool start_window_system();

/// Sets the name by which the desktop finds packaging/inkwell.desktop. Call before a window is created.
void set_program_name(const char* name);

/// Returns true if screen units are pixels. Wayland scales screen units.
bool has_pixel_units();

}  // namespace inkwell::window
