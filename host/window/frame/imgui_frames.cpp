#include <frame/imgui_frames.hpp>

#include <algorithm>
#include <cstddef>
#include <span>
#include <utility>

#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>

#include <frame/key_letters.hpp>
#include <frame/picture_digest.hpp>

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

Box box_of(const ImVec4& rectangle) { return {rectangle.x, rectangle.y, rectangle.z, rectangle.w}; }

DrawnPart part_of(const ImDrawList& list, const ImDrawCmd& command) {
  if (command.ElemCount == 0) return {};
  const std::span indices(list.IdxBuffer.Data + command.IdxOffset, command.ElemCount);
  const auto [first, last] = std::ranges::minmax(indices);
  const std::span corners(list.VtxBuffer.Data + command.VtxOffset + first, static_cast<std::size_t>(last - first) + 1);
  PictureDigest digest;
  digest.add_bytes(corners.data(), corners.size_bytes());
  // Counted from its first corner: what is drawn before it may have more or fewer of them.
  std::uint64_t order = 0;
  for (const ImDrawIdx index : indices) order = order * 0x9E3779B97F4A7C15u + static_cast<std::uint64_t>(index - first);
  digest.add(order);
  digest.add_bytes(&command.ClipRect, sizeof command.ClipRect);
  Box box{corners[0].pos.x, corners[0].pos.y, corners[0].pos.x, corners[0].pos.y};
  for (const ImDrawVert& corner : corners)
    box = {std::min(box.left, corner.pos.x), std::min(box.top, corner.pos.y), std::max(box.right, corner.pos.x),
           std::max(box.bottom, corner.pos.y)};
  return {common(box, box_of(command.ClipRect)), digest.value()};
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

void ImGuiFrames::note_key_down(int key) {
  taps_.note(key);
  // With what is held at that moment, which may be let go as well before the next frame.
  const bool* down = ImGui::GetIO().KeysDown;
  for (const int modifier : {GLFW_KEY_LEFT_CONTROL, GLFW_KEY_RIGHT_CONTROL, GLFW_KEY_LEFT_SHIFT, GLFW_KEY_RIGHT_SHIFT,
                             GLFW_KEY_LEFT_ALT, GLFW_KEY_RIGHT_ALT})
    if (down[modifier] && modifier != key) taps_.note(modifier);
}

void ImGuiFrames::begin() {
  ImGui_ImplOpenGL3_NewFrame();
  ImGui_ImplGlfw_NewFrame();
  ImGuiIO& io = ImGui::GetIO();
  follow_keyboard_layout(io);
  taps_.apply(io.KeysDown);
  io.KeyCtrl = io.KeysDown[GLFW_KEY_LEFT_CONTROL] || io.KeysDown[GLFW_KEY_RIGHT_CONTROL];
  io.KeyShift = io.KeysDown[GLFW_KEY_LEFT_SHIFT] || io.KeysDown[GLFW_KEY_RIGHT_SHIFT];
  io.KeyAlt = io.KeysDown[GLFW_KEY_LEFT_ALT] || io.KeysDown[GLFW_KEY_RIGHT_ALT];
  // ImGui's own way from part to part takes two of them only unless Ctrl stays down, and shows their inner names.
  io.KeyMap[ImGuiKey_Tab] = io.KeyCtrl ? -1 : GLFW_KEY_TAB;
  // Without anything to close or to leave ImGui would take the keyboard away from the thing that has it: Escape is for
  // the force then.
  constexpr ImGuiPopupFlags any = ImGuiPopupFlags_AnyPopupId | ImGuiPopupFlags_AnyPopupLevel;
  io.KeyMap[ImGuiKey_Escape] = ImGui::IsAnyItemActive() || ImGui::IsPopupOpen("", any) ? GLFW_KEY_ESCAPE : -1;
  ImGui::NewFrame();
}

ImVec2 ImGuiFrames::size() const { return ImGui::GetIO().DisplaySize; }
void ImGuiFrames::end() { ImGui::Render(); }

std::vector<DrawnPane> ImGuiFrames::panes() const {
  const ImDrawData& data = *ImGui::GetDrawData();
  std::vector<DrawnPane> panes;
  for (const ImDrawList* list : std::span(data.CmdLists, static_cast<std::size_t>(data.CmdListsCount))) {
    DrawnPane& pane = panes.emplace_back(DrawnPane{list, {}});
    for (const ImDrawCmd& command : list->CmdBuffer) pane.parts.push_back(part_of(*list, command));
  }
  return panes;
}

void ImGuiFrames::draw(const Box& box) const {
  // The back end draws what lies in a command's rectangle; those that have nothing in the box are not even uploaded.
  const ImDrawData& data = *ImGui::GetDrawData();
  std::vector<ImDrawList*> lists;
  std::vector<ImVec4> rectangles;
  for (ImDrawList* list : std::span(data.CmdLists, static_cast<std::size_t>(data.CmdListsCount))) {
    const auto is_in_box = [&box](const ImDrawCmd& each) { return !common(box_of(each.ClipRect), box).is_empty(); };
    if (std::none_of(list->CmdBuffer.begin(), list->CmdBuffer.end(), is_in_box)) continue;
    lists.push_back(list);
    for (ImDrawCmd& command : list->CmdBuffer) {
      rectangles.push_back(command.ClipRect);
      const Box part = common(box_of(command.ClipRect), box);
      command.ClipRect = {part.left, part.top, part.right, part.bottom};
    }
  }
  ImDrawData in_box = data;
  in_box.CmdLists = lists.data();
  in_box.CmdListsCount = static_cast<int>(lists.size());
  ImGui_ImplOpenGL3_RenderDrawData(&in_box);
  auto before = rectangles.begin();
  for (ImDrawList* list : lists)
    for (ImDrawCmd& command : list->CmdBuffer) command.ClipRect = *before++;
}

}  // namespace inkwell::window
