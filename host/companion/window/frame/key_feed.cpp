#include "host/companion/window/frame/key_feed.hpp"

#include <cstddef>
#include <utility>
#include <vector>

#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <imgui_internal.h>

#include "host/companion/window/frame/imgui_versions.hpp"
#include "host/companion/window/frame/key_letters.hpp"
#include "host/companion/window/frame/key_order.hpp"

namespace inkwell::window {

static_assert(space_bar == GLFW_KEY_SPACE && escape_key == GLFW_KEY_ESCAPE && tab_key == GLFW_KEY_TAB &&
              key_release == GLFW_RELEASE && shift_modifier == GLFW_MOD_SHIFT && control_modifier == GLFW_MOD_CONTROL);

namespace {

bool can_cancel() {
  return ImGui::IsAnyItemActive() || ImGui::IsPopupOpen("", ImGuiPopupFlags_AnyPopupId | ImGuiPopupFlags_AnyPopupLevel);
}

#if INKWELL_IMGUI_HAS_KEY_EVENTS

// ImGui 1.87 and later follows the keyboard layout without set-up.
void set_up_keys() {}
void note_tap(KeyTaps&, int) {}

bool events_wait() { return !GImGui->InputEventsQueue.empty(); }

QueuedInput kind_of(const ImGuiInputEvent& event) {
  if (event.Type != ImGuiInputEventType_Key) return QueuedInput::other;
  const ImGuiKey key = event.Key.Key;
  if ((key & ImGuiMod_Mask_) != 0) return QueuedInput::modifier;
  // The back end reports each modifier twice, as a modifier and as a key.
  const bool is_modifier_key = key >= ImGuiKey_LeftCtrl && key <= ImGuiKey_RightSuper;
  return event.Key.Down && !is_modifier_key ? QueuedInput::key_press : QueuedInput::other;
}

void start_frame(KeyTaps&) {
  ImVector<ImGuiInputEvent>& queue = GImGui->InputEventsQueue;
  std::vector<QueuedInput> kinds;
  for (const ImGuiInputEvent& event : queue) kinds.push_back(kind_of(event));
  const auto count = static_cast<std::ptrdiff_t>(events_of_frame(kinds));
  const std::vector<ImGuiInputEvent> later(queue.begin() + count, queue.end());
  queue.resize(static_cast<int>(count));
  ImGui::NewFrame();
  for (const ImGuiInputEvent& event : later) queue.push_back(event);
}

#else

// Called for every frame, because the user may change the keyboard layout at any time.
void follow_keyboard_layout(ImGuiIO& io) {
  const KeyLetters keys = key_letters([](int key) { return glfwGetKeyName(key, 0); });
  for (const auto& [letter, shortcut] :
       {std::pair{'a', ImGuiKey_A}, std::pair{'c', ImGuiKey_C}, std::pair{'v', ImGuiKey_V}, std::pair{'x', ImGuiKey_X},
        std::pair{'y', ImGuiKey_Y}, std::pair{'z', ImGuiKey_Z}})
    io.KeyMap[shortcut] = keys[static_cast<std::size_t>(letter - 'a')];
}

void set_up_keys() {
  // ImGui 1.86 activates controls with the space bar, so Enter is mapped to the space bar.
  ImGui::GetIO().KeyMap[ImGuiKey_Space] = GLFW_KEY_ENTER;
}

void note_tap(KeyTaps& taps, int key) {
  taps.note(key);
  // Records pressed modifier keys, because the user may release the modifiers before the next frame.
  const bool* down = ImGui::GetIO().KeysDown;
  for (const int modifier : {GLFW_KEY_LEFT_CONTROL, GLFW_KEY_RIGHT_CONTROL, GLFW_KEY_LEFT_SHIFT, GLFW_KEY_RIGHT_SHIFT,
                             GLFW_KEY_LEFT_ALT, GLFW_KEY_RIGHT_ALT})
    if (down[modifier] && modifier != key) taps.note(modifier);
}

bool events_wait() { return false; }

void start_frame(KeyTaps& taps) {
  ImGuiIO& io = ImGui::GetIO();
  follow_keyboard_layout(io);
  taps.apply(io.KeysDown);
  io.KeyCtrl = io.KeysDown[GLFW_KEY_LEFT_CONTROL] || io.KeysDown[GLFW_KEY_RIGHT_CONTROL];
  io.KeyShift = io.KeysDown[GLFW_KEY_LEFT_SHIFT] || io.KeysDown[GLFW_KEY_RIGHT_SHIFT];
  io.KeyAlt = io.KeysDown[GLFW_KEY_LEFT_ALT] || io.KeysDown[GLFW_KEY_RIGHT_ALT];
  ImGui::NewFrame();
}

#endif

}  // namespace

KeyFeed::KeyFeed(GLFWwindow* window) : window_(window) {
  // Hides the window's key callback from the back end, which must receive only the filtered keys.
  const GLFWkeyfun callback = glfwSetKeyCallback(window_, nullptr);
  ImGui_ImplGlfw_InitForOpenGL(window_, true);
  glfwSetKeyCallback(window_, callback);
  set_up_keys();
}

KeyFeed::~KeyFeed() {
  const GLFWkeyfun callback = glfwSetKeyCallback(window_, nullptr);
  ImGui_ImplGlfw_Shutdown();
  glfwSetKeyCallback(window_, callback);
}

void KeyFeed::take(const KeyEvent& event) {
  if (!is_for_imgui(event, can_cancel())) return;
  if (event.action == GLFW_PRESS) note_tap(taps_, event.key);
  ImGui_ImplGlfw_KeyCallback(window_, event.key, event.scancode, event.action, event.modifiers);
}

void KeyFeed::begin_frame() { start_frame(taps_); }
bool KeyFeed::has_waiting_events() const { return events_wait(); }

}  // namespace inkwell::window
