#include "host/companion/window/frame/frame_loop.hpp"

#include <cmath>
#include <csignal>
#include <utility>

#include <GLFW/glfw3.h>
#include <epoxy/gl.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "host/client/local/ending_signals.hpp"
#include "host/client/local/output.hpp"

#include "host/companion/window/frame/picture_digest.hpp"
#include "host/companion/window/frame/style.hpp"

namespace inkwell::window {

namespace {

constexpr double look_period_s = 1.0 / 60.0;  // polling interval for changed content at rest
constexpr double faster_than_display = 1.04;  // above the display rate, which is the usual limit

volatile std::sig_atomic_t asked_to_end = 0;

}  // namespace

void end_loop_at_signals() {
  static const local::EndingSignalsHandler handler([](int) { asked_to_end = 1; });
}

FrameLoop::FrameLoop(Display& display, ImGuiFrames& imgui, FrameContent& content, FrameLoopOptions options)
    : display_(display),
      imgui_(imgui),
      content_(content),
      options_(std::move(options)),
      inspection_(options_.inspection),
      pacer_(faster_than_display * display.refresh_rate_Hz(), !display.draws_in_software()),
      frames_report_(1.0 / display.refresh_rate_Hz()),
      started_s_(glfwGetTime()),
      shown_s_(started_s_) {
  display_.on_key([this](const KeyEvent& event) {
    content_.key(event);
    imgui_.take_key(event);
  });
}

void FrameLoop::run() {
  while (!display_.is_to_be_closed() && asked_to_end == 0) {
    Frame frame = next_frame();
    if (!is_due(frame)) continue;
    lay_out(frame);
    if (content_.is_over()) break;
    if (!update_evidence(frame)) continue;
    draw(frame);
    show(frame);
    if (frame.is_last) break;
  }
  if (!options_.frames_report) return;
  fmt::print("{}", frames_report_.text());
  local::flush_output();
}

FrameLoop::Frame FrameLoop::next_frame() {
  // Requests are read before the events, because an answer must reflect all earlier events.
  const bool is_asked = inspection_ && inspection_->collect_requests();
  const bool is_lively = rhythm_.is_lively(glfwGetTime());
  is_lively ? pacer_.wait() : pacer_.rest();
  if (is_lively || is_asked)
    display_.take_events();
  else
    display_.wait_for_events(look_period_s);
  const double now_s = glfwGetTime();
  return {.now_s = now_s,
          .size = display_.framebuffer_size(),
          .is_lively = is_lively,
          .is_asked = is_asked,
          .is_last = !options_.screenshot.empty() && now_s - started_s_ >= options_.after_seconds,
          .smooth = false,
          .evidence = {.input = display_.take_input()},
          .picture = {}};
}

bool FrameLoop::is_due(const Frame& frame) const {
  const bool something_happened = frame.evidence.input || frame.is_last || frame.is_asked || content_.needs_frame();
  return rhythm_.is_due(something_happened, frame.now_s) && frame.size.width > 0 && frame.size.height > 0;
}

void FrameLoop::lay_out(Frame& frame) {
  content_.prepare();
  imgui_.begin();
  if (inspection_) inspection_->begin_frame(display_.corner());
  content_.lay_out(imgui_.size(), frame.now_s);
  imgui_.end();

  const bool is_photographed = frame.is_last || (inspection_ && inspection_->wants_picture());
  // Screenshots and frames at a reduced rate are always antialiased.
  frame.smooth = pacer_.keeps_up() || !frame.is_lively || is_photographed;
  PictureDigest canvas;
  canvas.add(content_.canvas_digest());
  canvas.add(frame.smooth);
  frame.picture = {.window = {0, 0, imgui_.size().x, imgui_.size().y},
                   .width_pixels = frame.size.width,
                   .height_pixels = frame.size.height,
                   .ground = packed(content_.ground()),
                   .canvas = content_.canvas(),
                   .canvas_digest = canvas.value(),
                   .panes = imgui_.panes()};
}

bool FrameLoop::update_evidence(Frame& frame) {
  frame.evidence.moves = content_.is_moving();
  frame.evidence.differs =
      frame.picture != on_screen_ || display_.take_lost_picture() || frame.is_last || frame.is_asked;
  return rhythm_.record_evidence(frame.evidence, frame.now_s);
}

void FrameLoop::draw(const Frame& frame) {
  const std::vector<Box> parts = to_be_drawn(frame);
  float drawn = 0.0f;
  for (const Box& part : parts) {
    draw_part(frame, part);
    drawn += part.area();
  }
  if (display_.draws_in_software()) mark_.put();
  if (const auto wanted = content_.wanted_picture()) take_picture(frame, *wanted);
  if (frame.is_last) write_screenshot(options_.screenshot, frame.size.width, frame.size.height);
  // The answer waits until ImGui has applied all earlier events.
  if (!inspection_ || imgui_.has_waiting_events()) return;
  nlohmann::json known = content_.inspect();
  known["drawn_part"] = drawn / frame.picture.window.area();
  if (!inspection_->end_frame(known, frame.size.width, frame.size.height)) display_.close();
}

void FrameLoop::take_picture(const Frame& frame, const Box& box) {
  const float scale = static_cast<float>(frame.size.width) / imgui_.size().x;
  const auto pixels = [scale](float units) { return static_cast<int>(std::lround(units * scale)); };
  const Box inside = common(box, frame.picture.window);
  content_.take_picture(read_pixels(pixels(inside.left), frame.size.height - pixels(inside.bottom),
                                    pixels(inside.right - inside.left), pixels(inside.bottom - inside.top)));
}

std::vector<Box> FrameLoop::to_be_drawn(const Frame& frame) const {
  if (display_.draws_in_software() && mark_.is_there()) return changes_between(on_screen_, frame.picture);
  return {frame.picture.window};
}

void FrameLoop::draw_part(const Frame& frame, const Box& part) {
  const auto [width, height] = frame.size;
  const Box& canvas = frame.picture.canvas;
  const float pixels_per_unit = static_cast<float>(width) / imgui_.size().x;
  const auto pixels = [pixels_per_unit](float units) { return static_cast<int>(std::lround(units * pixels_per_unit)); };
  const ImVec4 ground = vector(content_.ground());
  glClearColor(ground.x, ground.y, ground.z, 1.0f);
  // Clearing the whole buffer is faster without the scissor test.
  part == frame.picture.window ? glDisable(GL_SCISSOR_TEST) : glEnable(GL_SCISSOR_TEST);
  glScissor(pixels(part.left), height - pixels(part.bottom), pixels(part.right - part.left),
            pixels(part.bottom - part.top));
  const bool is_painted = !common(part, canvas).is_empty();
  glClear((part == canvas ? 0u : GL_COLOR_BUFFER_BIT) |
          (is_painted ? GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT : 0u));
  if (is_painted)
    content_.paint({.pixels_per_unit = pixels_per_unit,
                    .height_pixels = height,
                    .smooth = frame.smooth,
                    .is_as_before = frame.picture.canvas_digest == on_screen_.canvas_digest});
  glViewport(0, 0, width, height);
  imgui_.draw(part);
}

void FrameLoop::show(const Frame& frame) {
  // Waits for the GPU, because the measured time must include the drawing.
  if (options_.frames_report || !frame.is_lively) glFinish();
  const double drawn_s = glfwGetTime();
  if (!frame.is_lively) rhythm_.took(drawn_s - frame.now_s);
  display_.show();
  on_screen_ = frame.picture;
  // The report excludes frames at a reduced rate.
  if (frame.is_lively) frames_report_.add(frame.now_s - shown_s_, drawn_s - frame.now_s, content_.pose_age_s());
  shown_s_ = frame.now_s;
}

}  // namespace inkwell::window
