#include "host/companion/window/frame/imgui_frames.hpp"

#include <algorithm>
#include <cstddef>
#include <span>

#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>

#include "host/companion/window/frame/imgui_versions.hpp"
#include "host/companion/window/frame/picture_digest.hpp"
#include "host/companion/window/frame/window_size.hpp"
#include "host/companion/window/frame/window_system.hpp"

namespace inkwell::window {

namespace {

Box box_of(const ImVec4& rectangle) { return {rectangle.x, rectangle.y, rectangle.z, rectangle.w}; }

DrawnPart part_of(const ImDrawList& list, const ImDrawCmd& command) {
  if (command.ElemCount == 0) return {};
  const std::span indices(list.IdxBuffer.Data + command.IdxOffset, command.ElemCount);
  const auto [first, last] = std::ranges::minmax(indices);
  const std::span corners(list.VtxBuffer.Data + command.VtxOffset + first, static_cast<std::size_t>(last - first) + 1);
  PictureDigest digest;
  digest.add_bytes(corners.data(), corners.size_bytes());
  // The digest uses relative vertex indices, because the number of earlier vertices may change.
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

void set_scale(float scale) { ImGui::GetIO().DisplayFramebufferScale = {scale, scale}; }

}  // namespace

void replace_font_atlas(ImFontAtlas* atlas) {
  ImGui_ImplOpenGL3_DestroyFontsTexture();
  ImFontAtlas* before = ImGui::GetIO().Fonts;
  before->Locked = false;
  ImGui::GetIO().Fonts = atlas;
  IM_DELETE(before);
  ImGui_ImplOpenGL3_CreateFontsTexture();
}

ImGuiFrames::Context::Context() {
  ImGui::CreateContext();
  ImGui::GetIO().IniFilename = nullptr;  // the layout is fixed, and the program has a separate settings file
  ImGui::GetIO().ConfigFlags |= ImGuiConfigFlags_NavEnableKeyboard;
}

ImGuiFrames::Context::~Context() { ImGui::DestroyContext(); }

ImGuiFrames::ImGuiFrames(GLFWwindow* window) : keys_(window) {
  ImGui_ImplOpenGL3_Init("#version 330 core");
  int width_units = 0, width_pixels = 0;
  glfwGetWindowSize(window, &width_units, nullptr);
  glfwGetFramebufferSize(window, &width_pixels, nullptr);
  set_scale(pixels_per_unit(width_units, width_pixels, has_pixel_units()));  // the first fonts need the scale
}

ImGuiFrames::~ImGuiFrames() { ImGui_ImplOpenGL3_Shutdown(); }

void ImGuiFrames::begin() {
  ImGui_ImplOpenGL3_NewFrame();
  ImGui_ImplGlfw_NewFrame();
  // The back end computes the scale from two queries, and a wrong scale would replace all fonts.
  if (has_pixel_units()) set_scale(1.0f);
  keys_.begin_frame();
}

ImVec2 ImGuiFrames::size() const { return ImGui::GetIO().DisplaySize; }
void ImGuiFrames::end() { ImGui::Render(); }

std::vector<DrawnPane> ImGuiFrames::panes() const {
  const ImDrawData& data = *ImGui::GetDrawData();
  std::vector<DrawnPane> panes;
  for (const ImDrawList* list : lists_of(data)) {
    DrawnPane& pane = panes.emplace_back(DrawnPane{list, {}});
    for (const ImDrawCmd& command : list->CmdBuffer) pane.parts.push_back(part_of(*list, command));
  }
  return panes;
}

void ImGuiFrames::draw(const Box& box) const {
  // Clips all draw commands to the box and omits draw lists outside the box.
  const ImDrawData& data = *ImGui::GetDrawData();
  std::vector<ImDrawList*> lists;
  std::vector<ImVec4> rectangles;
  for (ImDrawList* list : lists_of(data)) {
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
  set_lists(in_box, lists);
  ImGui_ImplOpenGL3_RenderDrawData(&in_box);
  auto before = rectangles.begin();
  for (ImDrawList* list : lists)
    for (ImDrawCmd& command : list->CmdBuffer) command.ClipRect = *before++;
}

}  // namespace inkwell::window
