// Selects X11 or Wayland. GLFW before 3.4, as in Debian 12, supports only X11. Only window_system.cpp depends on the
// version.
#pragma once

namespace inkwell::window {

/// Starts GLFW on X11 if available, otherwise on Wayland. With INKWELL_WINDOW_SYSTEM set to "wayland", Wayland has
/// priority. Returns false if no window system could be started. Throws DisplayError if the variable has another value.
bool start_window_system();

/// Sets the name by which a desktop finds the program's entry and icon in packaging/inkwell.desktop. Call this before a
/// window is created.
void set_program_name(const char* name);

/// True if a screen unit is a pixel. On Wayland screen units are already scaled.
bool has_pixel_units();

}  // namespace inkwell::window
