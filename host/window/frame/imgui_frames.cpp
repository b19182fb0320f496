#include <frame/imgui_frames.hpp>

#include <utility>

#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>

#include <frame/key_letters.hpp>

namespace inkwell::window {

namespace {

// Anew each frame, because the user may change the layout at any time.
void follow_keyboard_layout(ImGuiIO& io) {
  const KeyLetters keys = key_letters([](int key) { return glfwGetKeyName(key, 0); });
  for (const auto& [letter, shortcut] :
       {std::pair{'a', ImGuiKey_A}, std::pair{'c', ImGuiKey_C}, std::pair{'v', ImGuiKey_V}, std::pair{'x', ImGuiKey_X},
        std::pair{'y', ImGuiKey_Y}, std::pair{'z', ImGuiKey_Z}})
    io.KeyMap[shortcut] = keys[static_cast<std::size_t>(letter - 'a')];
}

}  // namespace

ImGuiFrames::ImGuiFrames(GLFWwindow* window) {
  ImGui::CreateContext();
  ImGui::GetIO().IniFilename = nullptr;  // the layout is ours, and so is the file of settings
  ImGui::GetIO().ConfigFlags |= ImGuiConfigFlags_NavEnableKeyboard;
  ImGui_ImplGlfw_InitForOpenGL(window, true);
  ImGui_ImplOpenGL3_Init("#version 330 core");
  // The space bar stops the arm; what has the keyboard is pressed by Enter instead.
  ImGui::GetIO().KeyMap[ImGuiKey_Space] = GLFW_KEY_ENTER;
}

ImGuiFrames::~ImGuiFrames() {
  ImGui_ImplOpenGL3_Shutdown();
  ImGui_ImplGlfw_Shutdown();
  ImGui::DestroyContext();
}

void ImGuiFrames::begin() {
  ImGui_ImplOpenGL3_NewFrame();
  ImGui_ImplGlfw_NewFrame();
  ImGuiIO& io = ImGui::GetIO();
  follow_keyboard_layout(io);
  taps_.apply(io.KeysDown);
  io.KeyCtrl = io.KeysDown[GLFW_KEY_LEFT_CONTROL] || io.KeysDown[GLFW_KEY_RIGHT_CONTROL];
  io.KeyShift = io.KeysDown[GLFW_KEY_LEFT_SHIFT] || io.KeysDown[GLFW_KEY_RIGHT_SHIFT];
  ImGui::NewFrame();
}

ImVec2 ImGuiFrames::size() const { return ImGui::GetIO().DisplaySize; }
void ImGuiFrames::end() { ImGui::Render(); }
const ImDrawData& ImGuiFrames::data() const { return *ImGui::GetDrawData(); }
void ImGuiFrames::draw() const { ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData()); }

}  // namespace inkwell::window
