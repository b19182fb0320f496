#include <window/window.hpp>

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <fstream>
#include <sstream>
#include <system_error>

#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>
#include <epoxy/gl.h>
#include <fmt/format.h>
#include <imgui.h>
#include <malloc.h>

#include <frame/display.hpp>
#include <frame/frame_rhythm.hpp>
#include <frame/frames_report.hpp>
#include <frame/inspection.hpp>
#include <frame/key_taps.hpp>
#include <frame/picture_digest.hpp>

#include "companion.hpp"

namespace inkwell::window {

namespace {

constexpr double look_period_s = 1.0 / 60.0;  // at rest: how often it is looked whether the device moves

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
  if (!options.layout.empty()) settings.scope.layout = layout_named(options.layout, settings.scope.own_layouts);
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

volatile std::sig_atomic_t asked_to_end = 0;

void run(const WindowOptions& options) {
  // Ended from a terminal it closes as by its button: force off, parameters on trial put back, settings kept.
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) std::signal(signal, [](int) { asked_to_end = 1; });
  Display display(options.width, options.height, "Inkwell");
  const ImGuiScope imgui(display.handle());
  const float scale = options.scale > 0.0f ? options.scale : display.content_scale();
  const WindowSettings settings = remembered_settings(options);
  Companion companion(options, settings, scale);
  KeyTaps taps;
  display.on_key([&companion, &taps](int key, bool down) {
    if (down) taps.note(key);
    companion.key(key, down);
  });
  std::optional<Inspection> inspection;
  if (options.inspect) inspection.emplace(&glfwPostEmptyEvent);
  // A little faster than the display, which then sets the pace; without a display that does, it is the pace.
  FramePacer pacer(1.04 * display.refresh_rate_Hz(), !display.draws_in_software());

  const double started_s = glfwGetTime();
  FrameRhythm rhythm;
  // Of the frames at the full rate only: at rest there are few on purpose.
  FramesReport frames_report(1.0 / display.refresh_rate_Hz());
  double previous_s = started_s;
  std::uint64_t scene_on_screen = 0;
  std::uint64_t panes_on_screen = 0;
  bool smooth_on_screen = false;
  while (glfwWindowShouldClose(display.handle()) == 0 && asked_to_end == 0) {
    const bool is_lively = rhythm.is_lively(glfwGetTime());
    if (is_lively) {
      pacer.wait();
      glfwPollEvents();
    } else {
      pacer.rest();
      glfwWaitEventsTimeout(look_period_s);
    }
    const double now_s = glfwGetTime();
    const bool is_last = !options.screenshot.empty() && now_s - started_s >= options.after_seconds;
    FrameEvidence evidence{.input = display.take_input()};
    const bool is_asked = inspection && inspection->is_asked();
    if (!rhythm.is_due(evidence.input || is_last || is_asked || companion.device_moves(), now_s)) continue;
    int width = 0;
    int height = 0;
    glfwGetFramebufferSize(display.handle(), &width, &height);
    if (width == 0 || height == 0) continue;  // shrunk to an icon

    ImGui_ImplOpenGL3_NewFrame();
    ImGui_ImplGlfw_NewFrame();
    ImGuiIO& io = ImGui::GetIO();
    taps.apply(io.KeysDown);
    io.KeyCtrl = io.KeysDown[GLFW_KEY_LEFT_CONTROL] || io.KeysDown[GLFW_KEY_RIGHT_CONTROL];
    io.KeyShift = io.KeysDown[GLFW_KEY_LEFT_SHIFT] || io.KeysDown[GLFW_KEY_RIGHT_SHIFT];
    ImGui::NewFrame();
    const ImVec2 size = ImGui::GetIO().DisplaySize;
    const auto arrived = companion.newest_arrived();
    if (inspection) inspection->begin_frame(display.corner());
    companion.draw(size, now_s);
    ImGui::Render();

    // At rest there is time for a smooth picture.
    const bool is_photographed = is_last || (inspection && inspection->wants_picture());
    const bool smooth = pacer.keeps_up() || !is_lively || is_photographed;
    const std::uint64_t scene = companion.scene_digest();
    PictureDigest panes;
    panes.add(*ImGui::GetDrawData());
    evidence.moves = companion.is_moving();
    evidence.differs = scene != scene_on_screen || panes.value() != panes_on_screen || smooth != smooth_on_screen ||
                       display.take_lost_picture() || is_last || is_asked;
    if (!rhythm.is_to_be_drawn(evidence, now_s)) continue;

    const ImVec4 ground = vector(companion.colours().panel);
    glClearColor(ground.x, ground.y, ground.z, 1.0f);
    glDisable(GL_SCISSOR_TEST);  // ImGui's back end leaves it on; a whole buffer is cleared fastest
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT);
    companion.draw_scene(static_cast<float>(width) / size.x, height, smooth, scene == scene_on_screen);
    glViewport(0, 0, width, height);
    ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
    if (is_last) write_screenshot(options.screenshot, width, height);
    if (inspection && !inspection->end_frame(companion.inspect(arrived), width, height))
      glfwSetWindowShouldClose(display.handle(), GLFW_TRUE);
    if (options.frames_report) glFinish();  // so that the time is that of drawing, not that of asking for it
    const double drawn_s = glfwGetTime();
    glfwSwapBuffers(display.handle());
    scene_on_screen = scene;
    panes_on_screen = panes.value();
    smooth_on_screen = smooth;
    if (is_lively) frames_report.add(now_s - previous_s, drawn_s - now_s, companion.pose_age_s());
    previous_s = now_s;
    if (is_last) break;
  }
  if (options.frames_report) {
    fmt::print("{}", frames_report.text());
    std::fflush(stdout);
  }
  if (options.persist_settings) remember_settings(companion.settings());
}

/// Each frame takes some megabytes and gives them back. Returned to the system every time, they would cost a page
/// fault for each of their pages, a third of the time in which a frame is prepared.
void keep_memory_between_frames() {
  constexpr int kept_bytes = 64 << 20;
  mallopt(M_TRIM_THRESHOLD, kept_bytes);
  mallopt(M_MMAP_THRESHOLD, kept_bytes);
}

}  // namespace

int run_window(const WindowOptions& options) {
  keep_memory_between_frames();
  try {
    run(options);
    return 0;
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
}

}  // namespace inkwell::window
