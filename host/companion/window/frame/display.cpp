#include "host/companion/window/frame/display.hpp"

#include <algorithm>
#include <cstdint>
#include <optional>
#include <vector>

#include <GLFW/glfw3.h>
#include <epoxy/gl.h>
#include <png.h>

#include "host/companion/window/frame/window_system.hpp"

namespace inkwell::window {

namespace {

/// Returns the scale that the desktop reports for the main display, such as 2 for 192 dots per inch.
float monitor_scale() {
  float x = 1.0f;
  float y = 1.0f;
  if (GLFWmonitor* monitor = glfwGetPrimaryMonitor()) glfwGetMonitorContentScale(monitor, &x, &y);
  return std::max(x, y);
}

/// Returns the usable area of the main display in pixels; empty if the desktop does not report the area.
std::optional<ScreenSize> monitor_room() {
  int x = 0, y = 0;
  ScreenSize room{0, 0};
  if (GLFWmonitor* monitor = glfwGetPrimaryMonitor())
    glfwGetMonitorWorkarea(monitor, &x, &y, &room.width, &room.height);
  return room.width > 0 && room.height > 0 ? std::optional(room) : std::nullopt;
}

/// Returns the scale of a new window on Wayland, such as 1.25. Wayland rounds the scale of a monitor up to a whole
/// number, and reports the exact scale only to a window with contents.
float window_scale(GLFWwindow* window) {
  constexpr int waits = 5;
  constexpr double wait_s = 0.02;
  glClear(GL_COLOR_BUFFER_BIT);
  glfwSwapBuffers(window);
  for (int i = 0; i < waits; ++i) glfwWaitEventsTimeout(wait_s);
  float x = 1.0f, y = 1.0f;
  glfwGetWindowContentScale(window, &x, &y);
  return std::max(x, y);
}

std::string last_glfw_error() {
  const char* description = nullptr;
  glfwGetError(&description);
  return description == nullptr ? "no reason reported" : description;
}

}  // namespace

Display::Display(ScreenSize points, float scale, const std::string& title) {
  if (!start_window_system())
    throw DisplayError(
        "No display could be opened (" + last_glfw_error() +
        "). Run inkwell in a graphical session, or use a command that needs no display (inkwell --help).");
  glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
  glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
  glfwWindowHint(GLFW_OPENGL_FORWARD_COMPAT, GLFW_TRUE);
  glfwWindowHint(GLFW_SAMPLES, 0);
  glfwWindowHint(GLFW_DEPTH_BITS, 24);
  glfwWindowHint(GLFW_STENCIL_BITS, 8);
  set_program_name("inkwell");
  const auto room = monitor_room();
  auto fit = fit_window(points, display_scale(monitor_scale(), has_pixel_units()), scale, room);
  window_ = glfwCreateWindow(fit.size.width, fit.size.height, title.c_str(), nullptr, nullptr);
  if (window_ == nullptr) {
    const std::string reason = last_glfw_error();
    glfwTerminate();
    throw DisplayError("OpenGL 3.3 is needed, but this display does not provide OpenGL 3.3 (" + reason +
                       "). Install a driver for the graphics card. Without a graphics card, install libgl1-mesa-dri "
                       "and set LIBGL_ALWAYS_SOFTWARE=1.");
  }
  glfwMakeContextCurrent(window_);
  if (!has_pixel_units() && monitor_scale() > 1.0f) {
    fit = fit_window(points, display_scale(window_scale(window_), false), scale, room);
    glfwSetWindowSize(window_, fit.size.width, fit.size.height);
  }
  scale_ = fit.units_per_point;
  glfwSetWindowSizeLimits(window_, fit.smallest.width, fit.smallest.height, GLFW_DONT_CARE, GLFW_DONT_CARE);
  glfwSwapInterval(1);
  glfwSetWindowUserPointer(window_, this);
  glfwSetKeyCallback(window_, [](GLFWwindow* window, int key, int scancode, int action, int modifiers) {
    auto* display = static_cast<Display*>(glfwGetWindowUserPointer(window));
    display->had_input_ = true;
    if (display->on_key_) display->on_key_({key, scancode, action, modifiers});
  });
  // ImGui's callbacks call these callbacks first.
  static constexpr auto note_input = [](GLFWwindow* window) {
    static_cast<Display*>(glfwGetWindowUserPointer(window))->had_input_ = true;
  };
  glfwSetCursorPosCallback(window_, [](GLFWwindow* window, double, double) { note_input(window); });
  glfwSetMouseButtonCallback(window_, [](GLFWwindow* window, int, int, int) { note_input(window); });
  glfwSetScrollCallback(window_, [](GLFWwindow* window, double, double) { note_input(window); });
  glfwSetCharCallback(window_, [](GLFWwindow* window, unsigned) { note_input(window); });
  glfwSetWindowFocusCallback(window_, [](GLFWwindow* window, int) { note_input(window); });
  glfwSetCursorEnterCallback(window_, [](GLFWwindow* window, int) { note_input(window); });
  glfwSetFramebufferSizeCallback(window_, [](GLFWwindow* window, int, int) { note_input(window); });
  glfwSetWindowRefreshCallback(window_, [](GLFWwindow* window) {
    note_input(window);
    static_cast<Display*>(glfwGetWindowUserPointer(window))->lost_picture_ = true;
  });
}

Display::~Display() {
  glfwDestroyWindow(window_);
  glfwTerminate();
}

double Display::refresh_rate_Hz() const {
  GLFWmonitor* monitor = glfwGetPrimaryMonitor();
  const GLFWvidmode* mode = monitor == nullptr ? nullptr : glfwGetVideoMode(monitor);
  return mode == nullptr || mode->refreshRate < 30 ? 60.0 : mode->refreshRate;
}

bool Display::draws_in_software() const {
  // llvmpipe and softpipe are Mesa's software renderers.
  const std::string_view renderer = reinterpret_cast<const char*>(glGetString(GL_RENDERER));
  return renderer.starts_with("llvmpipe") || renderer.starts_with("softpipe");
}

ImVec2 Display::corner() const {
  int x = 0;
  int y = 0;
  glfwGetWindowPos(window_, &x, &y);
  return {static_cast<float>(x), static_cast<float>(y)};
}

Display::Size Display::framebuffer_size() const {
  Size size{};
  glfwGetFramebufferSize(window_, &size.width, &size.height);
  return size;
}

bool Display::is_to_be_closed() const { return glfwWindowShouldClose(window_) != 0; }
void Display::close() { glfwSetWindowShouldClose(window_, GLFW_TRUE); }
void Display::take_events() { glfwPollEvents(); }
void Display::wait_for_events(double at_most_s) { glfwWaitEventsTimeout(at_most_s); }
void Display::wake() { glfwPostEmptyEvent(); }
void Display::show() { glfwSwapBuffers(window_); }

Pixels read_pixels(int left, int bottom, int width, int height) {
  Pixels pixels{width, height, {}};
  pixels.rgb.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * 3);
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(left, bottom, width, height, GL_RGB, GL_UNSIGNED_BYTE, pixels.rgb.data());
  return pixels;
}

std::string write_png(const std::filesystem::path& file, const Pixels& pixels) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = static_cast<png_uint_32>(pixels.width);
  image.height = static_cast<png_uint_32>(pixels.height);
  image.format = PNG_FORMAT_RGB;
  // OpenGL stores the lowest row first, so the negative stride reverses the order of the rows.
  if (png_image_write_to_file(&image, file.c_str(), 0, pixels.rgb.data(), -3 * pixels.width, nullptr) != 0) return {};
  return "The picture " + file.string() + " cannot be written: " + image.message + ".";
}

void write_screenshot(const std::filesystem::path& path, int width, int height) {
  if (const std::string problem = write_png(path, read_pixels(0, 0, width, height)); !problem.empty())
    throw DisplayError(problem);
}

}  // namespace inkwell::window
