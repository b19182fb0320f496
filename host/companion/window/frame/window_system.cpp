#include "host/companion/window/frame/window_system.hpp"

#include <array>
#include <cstdlib>
#include <string>
#include <string_view>
#include <utility>

#include <GLFW/glfw3.h>

#include "host/companion/window/frame/display.hpp"

namespace inkwell::window {

namespace {

constexpr const char* choice_variable = "INKWELL_WINDOW_SYSTEM";

std::string_view variable(const char* name) {
  const char* value = std::getenv(name);
  return value == nullptr ? std::string_view() : value;
}

bool prefers_wayland() {
  const std::string_view choice = variable(choice_variable).empty() ? "x11" : variable(choice_variable);
  if (choice != "x11" && choice != "wayland")
    throw DisplayError(std::string(choice_variable) + " is `" + std::string(choice) +
                       "`. Set the variable to x11 or wayland, or unset the variable.");
  return choice == "wayland";
}

}  // namespace

#if GLFW_VERSION_MAJOR > 3 || (GLFW_VERSION_MAJOR == 3 && GLFW_VERSION_MINOR >= 4)

bool start_window_system() {
  // X11 has priority even in a Wayland session, because a GLFW window on Wayland has no icon and may lack a title bar.
  std::array order{GLFW_PLATFORM_X11, GLFW_PLATFORM_WAYLAND};
  if (prefers_wayland()) std::swap(order[0], order[1]);
  for (const int platform : order) {
    // Without WAYLAND_DISPLAY, the Wayland library might connect to the session of a different desktop.
    if (platform == GLFW_PLATFORM_WAYLAND && variable("WAYLAND_DISPLAY").empty()) continue;
    if (glfwPlatformSupported(platform) != GLFW_TRUE) continue;
    glfwInitHint(GLFW_PLATFORM, platform);
    if (glfwInit() == GLFW_TRUE) return true;
  }
  return false;
}

void set_program_name(const char* name) {
  glfwWindowHintString(GLFW_X11_CLASS_NAME, name);
  glfwWindowHintString(GLFW_X11_INSTANCE_NAME, name);
  glfwWindowHintString(GLFW_WAYLAND_APP_ID, name);
}

bool has_pixel_units() { return glfwGetPlatform() != GLFW_PLATFORM_WAYLAND; }

#else

bool start_window_system() {
  prefers_wayland();  // also reports an invalid value
  return glfwInit() == GLFW_TRUE;
}

void set_program_name(const char* name) {
  glfwWindowHintString(GLFW_X11_CLASS_NAME, name);
  glfwWindowHintString(GLFW_X11_INSTANCE_NAME, name);
}

bool has_pixel_units() {
  // The package libglfw3-wayland replaces the X11 library at run time. Its version text begins with "3.3.8 Wayland".
  return std::string_view(glfwGetVersionString()).find("Wayland") == std::string_view::npos;
}

#endif

}  // namespace inkwell::window
