#include <window/window.hpp>

#include <algorithm>
#include <cstdio>
#include <fmt/format.h>
#include <fstream>
#include <sstream>
#include <system_error>

#include <epoxy/gl.h>
#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>
#include <imgui.h>

#include "companion.hpp"
#include "display.hpp"
#include "renderer.hpp"

namespace inkwell::window {

namespace {

constexpr double lively_for_s = 0.5;
constexpr double idle_period_s = 0.1;

/// ImGui with its two back ends, for as long as the window is open.
class ImGuiScope {
 public:
  explicit ImGuiScope(GLFWwindow* window) {
    ImGui::CreateContext();
    ImGui::GetIO().IniFilename = nullptr;  // the layout is ours, and so is the file of settings
    ImGui_ImplGlfw_InitForOpenGL(window, true);
    ImGui_ImplOpenGL3_Init("#version 330 core");
  }
  ~ImGuiScope() {
    ImGui_ImplOpenGL3_Shutdown();
    ImGui_ImplGlfw_Shutdown();
    ImGui::DestroyContext();
  }
  ImGuiScope(const ImGuiScope&) = delete;
  ImGuiScope& operator=(const ImGuiScope&) = delete;
};

WindowSettings remembered_settings(const WindowOptions& options) {
  WindowSettings settings;
  if (const auto path = window_settings_path(); options.persist_settings && !path.empty()) {
    std::ifstream stream(path);
    std::ostringstream text;
    text << stream.rdbuf();
    settings = parse_settings(text.str());
  }
  if (options.theme) settings.theme = *options.theme;
  if (!options.layout.empty()) settings.layout = built_in_layout(options.layout);
  return settings;
}

void remember_settings(const WindowSettings& settings) {
  const auto path = window_settings_path();
  if (path.empty()) return;
  // A new file first, so that a full disk leaves the old one whole.
  const std::filesystem::path unfinished = path.string() + ".new";
  std::error_code error;
  std::filesystem::create_directories(path.parent_path(), error);
  std::ofstream stream(unfinished);
  stream << format_settings(settings);
  stream.close();
  if (stream) {
    std::filesystem::rename(unfinished, path, error);
  } else {
    std::filesystem::remove(unfinished, error);
    fmt::print(stderr, "The window's settings could not be kept in {}. Check that its disk is not full.\n",
               path.string());
  }
}

void run(const WindowOptions& options) {
  Display display(options.width, options.height, "Inkwell");
  const ImGuiScope imgui(display.handle());
  const float scale = options.scale > 0.0f ? options.scale : display.content_scale();
  const WindowSettings settings = remembered_settings(options);
  Companion companion(options, settings, scale);
  display.on_key([&companion](int key, bool down) { companion.key(key, down); });
  Renderer renderer;
  // A little faster than the display, which then sets the pace; without a display that does, it is the pace.
  FramePacer pacer(1.02 * display.refresh_rate_Hz());

  const double started_s = glfwGetTime();
  // Of the frames at the full rate only: at rest there are few on purpose.
  std::uint64_t frames = 0;
  double frames_s = 0.0;
  double drawing_s = 0.0;
  double previous_s = started_s;
  double last_lively_s = started_s;
  while (glfwWindowShouldClose(display.handle()) == 0) {
    const bool is_lively = glfwGetTime() - last_lively_s < lively_for_s;
    if (is_lively) {
      pacer.wait();
      glfwPollEvents();
    } else {
      // Nothing moves: a few frames a second are enough to see it when something does.
      const double before_s = glfwGetTime();
      glfwWaitEventsTimeout(idle_period_s);
      if (glfwGetTime() - before_s < 0.9 * idle_period_s) last_lively_s = glfwGetTime();
    }
    const double now_s = glfwGetTime();
    int width = 0;
    int height = 0;
    glfwGetFramebufferSize(display.handle(), &width, &height);
    if (width == 0 || height == 0) continue;  // shrunk to an icon

    ImGui_ImplOpenGL3_NewFrame();
    ImGui_ImplGlfw_NewFrame();
    ImGui::NewFrame();
    const ImVec2 size = ImGui::GetIO().DisplaySize;
    companion.draw(size, now_s);
    ImGui::Render();
    if (companion.is_moving()) last_lively_s = now_s;

    const bool is_last = !options.screenshot.empty() && now_s - started_s >= options.after_seconds;
    const ImVec4 ground = vector(companion.colours().panel);
    glClearColor(ground.x, ground.y, ground.z, 1.0f);
    glDisable(GL_SCISSOR_TEST);  // ImGui's back end leaves it on; a whole buffer is cleared fastest
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT);
    companion.draw_scene(renderer, static_cast<float>(width) / size.x, height, pacer.keeps_up() || is_last);
    glViewport(0, 0, width, height);
    ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
    if (is_last) write_screenshot(options.screenshot, width, height);
    if (options.frames_report) glFinish();  // so that the time is that of drawing, not that of asking for it
    const double drawn_s = glfwGetTime();
    glfwSwapBuffers(display.handle());
    if (is_lively) {
      ++frames;
      frames_s += now_s - previous_s;
      drawing_s += drawn_s - now_s;
    }
    previous_s = now_s;
    if (is_last) break;
  }
  if (options.frames_report) {
    const auto count = static_cast<double>(std::max<std::uint64_t>(frames, 1));
    fmt::print("{:.1f} frames per second while something moved ({:.1f} s), {:.1f} ms to draw one\n",
               count / std::max(frames_s, 1e-3), frames_s, 1000.0 * drawing_s / count);
    std::fflush(stdout);
  }
  if (options.persist_settings) remember_settings(companion.settings());
}

}  // namespace

int run_window(const WindowOptions& options) {
  try {
    run(options);
    return 0;
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
}

}  // namespace inkwell::window
