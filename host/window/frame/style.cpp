#include <frame/style.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>

#include <imgui_freetype.h>
#include <imgui_internal.h>

#include <frame/inspection.hpp>

namespace inkwell::window {

namespace {

struct FontFiles {
  const char* regular;
  const char* strong;
};

constexpr std::array<FontFiles, 3> font_files{{
    {"/usr/share/fonts/opentype/inter/Inter-Regular.otf", "/usr/share/fonts/opentype/inter/Inter-SemiBold.otf"},
    {"/usr/share/fonts/truetype/inter/Inter-Regular.ttf", "/usr/share/fonts/truetype/inter/Inter-SemiBold.ttf"},
    {"/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf", "/usr/share/fonts/truetype/dejavu/DejaVuSans-Bold.ttf"},
}};

// Latin, Greek, and the punctuation, arrows and marks that the panes use.
constexpr ImWchar glyph_ranges[] = {0x0020, 0x00FF, 0x0370, 0x03FF, 0x2010, 0x2026, 0x2190, 0x2193, 0x21B6,
                                    0x21BB, 0x2212, 0x2212, 0x25A0, 0x25CF, 0x2713, 0x2717, 0};

ImFont* add_font(const char* file, float pixels) {
  ImFontConfig configuration;
  configuration.OversampleH = 1;
  configuration.PixelSnapH = true;
  return ImGui::GetIO().Fonts->AddFontFromFileTTF(file, pixels, &configuration, glyph_ranges);
}

// Digits of one width, so that a number that changes does not make its neighbours tremble.
void make_digits_tabular(ImFont* font) {
  float widest = 0.0f;
  for (ImWchar digit = '0'; digit <= '9'; ++digit)
    if (const ImFontGlyph* glyph = font->FindGlyphNoFallback(digit)) widest = std::max(widest, glyph->AdvanceX);
  for (ImFontGlyph& glyph : font->Glyphs) {
    if (glyph.Codepoint < '0' || glyph.Codepoint > '9') continue;
    const float shift = std::floor(0.5f * (widest - glyph.AdvanceX) + 0.5f);
    glyph.X0 += shift;
    glyph.X1 += shift;
    glyph.AdvanceX = widest;
    font->IndexAdvanceX[static_cast<int>(glyph.Codepoint)] = widest;
  }
}

}  // namespace

Fonts load_fonts(float scale) {
  ImFontAtlas& atlas = *ImGui::GetIO().Fonts;
  atlas.Clear();
  atlas.FontBuilderIO = ImGuiFreeType::GetBuilderForFreeType();
  atlas.FontBuilderFlags = ImGuiFreeTypeBuilderFlags_LightHinting;
  const auto found = std::ranges::find_if(font_files, [](const FontFiles& files) {
    return std::filesystem::exists(files.regular) && std::filesystem::exists(files.strong);
  });
  if (found == font_files.end()) {
    ImFontConfig configuration;
    configuration.SizePixels = std::round(13.0f * scale);
    ImFont* only = atlas.AddFontDefault(&configuration);
    atlas.Build();
    return {only, only, only};
  }
  const Fonts fonts{add_font(found->regular, std::round(15.0f * scale)),
                    add_font(found->strong, std::round(15.0f * scale)),
                    add_font(found->regular, std::round(12.5f * scale))};
  atlas.Build();
  for (ImFont* font : {fonts.body, fonts.strong, fonts.caption}) make_digits_tabular(font);
  return fonts;
}

ImVec4 vector(Colour colour) { return ImGui::ColorConvertU32ToFloat4(packed(colour)); }

void apply_theme(const Palette& palette, float scale) {
  ImGuiStyle style;
  style.WindowPadding = {14, 12};
  style.FramePadding = {9, 5};
  style.ItemSpacing = {8, 7};
  style.ItemInnerSpacing = {7, 4};
  style.WindowRounding = 0;
  style.ChildRounding = 6;
  style.FrameRounding = 5;
  style.PopupRounding = 7;
  style.GrabRounding = 5;
  style.GrabMinSize = 11;
  style.ScrollbarSize = 11;
  style.ScrollbarRounding = 6;
  style.WindowBorderSize = 0;
  style.ChildBorderSize = 0;
  style.PopupBorderSize = 1;
  style.FrameBorderSize = 0;
  style.IndentSpacing = 14;
  style.ScaleAllSizes(scale);
  style.AntiAliasedLinesUseTex = true;

  const auto set = [&style](ImGuiCol slot, Colour colour) { style.Colors[slot] = vector(colour); };
  set(ImGuiCol_Text, palette.text);
  set(ImGuiCol_TextDisabled, palette.text_quiet);
  set(ImGuiCol_WindowBg, palette.panel);
  set(ImGuiCol_ChildBg, palette.panel.with_alpha(0));
  set(ImGuiCol_PopupBg, palette.panel);
  set(ImGuiCol_Border, palette.line);
  set(ImGuiCol_FrameBg, palette.raised);
  set(ImGuiCol_FrameBgHovered, palette.raised_hover);
  set(ImGuiCol_FrameBgActive, palette.raised_active);
  set(ImGuiCol_ScrollbarBg, palette.panel.with_alpha(0));
  set(ImGuiCol_ScrollbarGrab, palette.raised);
  set(ImGuiCol_ScrollbarGrabHovered, palette.raised_hover);
  set(ImGuiCol_ScrollbarGrabActive, palette.raised_active);
  set(ImGuiCol_CheckMark, palette.accent);
  set(ImGuiCol_SliderGrab, palette.accent);
  set(ImGuiCol_SliderGrabActive, palette.accent);
  set(ImGuiCol_Button, palette.raised);
  set(ImGuiCol_ButtonHovered, palette.raised_hover);
  set(ImGuiCol_ButtonActive, palette.raised_active);
  set(ImGuiCol_Header, palette.panel.with_alpha(0));
  set(ImGuiCol_HeaderHovered, palette.raised);
  set(ImGuiCol_HeaderActive, palette.raised_hover);
  set(ImGuiCol_Separator, palette.line);
  set(ImGuiCol_SeparatorHovered, palette.accent);
  set(ImGuiCol_SeparatorActive, palette.accent);
  set(ImGuiCol_ModalWindowDimBg, palette.ground.with_alpha(150));
  set(ImGuiCol_TextSelectedBg, palette.accent.with_alpha(90));
  set(ImGuiCol_NavHighlight, palette.accent);
  ImGui::GetStyle() = style;
}

void text(Colour colour, std::string_view content) {
  note_text(content);
  ImGui::PushStyleColor(ImGuiCol_Text, packed(colour));
  ImGui::TextUnformatted(content.data(), content.data() + content.size());
  ImGui::PopStyleColor();
}

void text(ImFont* font, Colour colour, std::string_view content) {
  ImGui::PushFont(font);
  text(colour, content);
  ImGui::PopFont();
}

void wrapped_text(Colour colour, std::string_view content) {
  ImGui::PushTextWrapPos(0.0f);
  text(colour, content);
  ImGui::PopTextWrapPos();
}

void right_text(Colour colour, std::string_view content, float width) {
  const float taken = ImGui::CalcTextSize(content.data(), content.data() + content.size()).x;
  ImGui::SetCursorPosX(ImGui::GetCursorPosX() + std::max(0.0f, width - taken));
  text(colour, content);
}

float warning_sign(ImVec2 corner, Colour colour, const Style& style) {
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const float size = style.points(14);
  const float middle = corner.x + 0.5f * size;
  const float top = corner.y + style.points(3);
  list.AddTriangleFilled({middle, top}, {corner.x + size, top + 0.9f * size}, {corner.x, top + 0.9f * size},
                         packed(colour));
  const ImU32 mark = packed(style.palette->panel);
  list.AddLine({middle, top + 0.33f * size}, {middle, top + 0.6f * size}, mark, style.points(1.6f));
  list.AddCircleFilled({middle, top + 0.74f * size}, style.points(1.0f), mark);
  return size + style.points(4);
}

bool is_dialog_open() { return ImGui::GetTopMostPopupModal() != nullptr; }

void same_line_if_room(float width) {
  const float right = ImGui::GetWindowPos().x + ImGui::GetWindowContentRegionMax().x;
  if (ImGui::GetItemRectMax().x + ImGui::GetStyle().ItemSpacing.x + width <= right) ImGui::SameLine();
}

void help_on_hover(std::string_view title, std::string_view help, const Style& style) {
  if (!ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled) || ImGui::IsItemActive()) return;
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2{style.points(11), style.points(9)});
  ImGui::BeginTooltip();
  ImGui::PushTextWrapPos(style.points(300));
  if (!title.empty()) text(style.fonts.strong, style.palette->text, title);
  text(style.palette->text_quiet, help);
  ImGui::PopTextWrapPos();
  ImGui::EndTooltip();
  ImGui::PopStyleVar();
}

bool button(const char* label, ImVec2 size) {
  const bool pressed = ImGui::Button(label, size);
  note_item(label);
  return pressed;
}

bool quiet_button(const char* label, const Style& style) {
  ImGui::PushStyleColor(ImGuiCol_Button, packed(style.palette->panel.with_alpha(0)));
  ImGui::PushStyleColor(ImGuiCol_Text, packed(style.palette->text_quiet));
  const bool pressed = button(label);
  ImGui::PopStyleColor(2);
  return pressed;
}

bool coloured_button(const char* label, Colour colour, Colour text_colour, ImVec2 size) {
  const auto lighter = [](Colour c, int by) {
    const auto up = [by](std::uint8_t part) { return static_cast<std::uint8_t>(std::clamp(part + by, 0, 255)); };
    return Colour{up(c.red), up(c.green), up(c.blue), c.alpha};
  };
  ImGui::PushStyleColor(ImGuiCol_Button, packed(colour));
  ImGui::PushStyleColor(ImGuiCol_ButtonHovered, packed(lighter(colour, 16)));
  ImGui::PushStyleColor(ImGuiCol_ButtonActive, packed(lighter(colour, -16)));
  ImGui::PushStyleColor(ImGuiCol_Text, packed(text_colour));
  const bool pressed = button(label, size);
  ImGui::PopStyleColor(4);
  return pressed;
}

bool toggle_button(const char* label, bool on, const Style& style, ImVec2 size) {
  if (on) return coloured_button(label, style.palette->accent, style.palette->panel, size);
  return button(label, size);
}

bool bar_slider(const char* label, float& value, float minimum, float maximum, const char* format,
                ImGuiSliderFlags flags, float width, const Style& style) {
  const Palette& palette = *style.palette;
  const ImVec2 corner = ImGui::GetCursorScreenPos();
  const ImVec2 end{corner.x + width, corner.y + ImGui::GetFrameHeight()};
  const bool hovered = ImGui::IsMouseHoveringRect(corner, end) && ImGui::IsWindowHovered();
  const float linear = (value - minimum) / (maximum - minimum);
  const float part =
      (flags & ImGuiSliderFlags_Logarithmic) != 0 ? std::log(value / minimum) / std::log(maximum / minimum) : linear;
  const float edge = corner.x + std::clamp(part, 0.0f, 1.0f) * width;
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const float rounding = ImGui::GetStyle().FrameRounding;
  list.AddRectFilled(corner, end, packed(hovered ? palette.raised_hover : palette.raised), rounding);
  if (edge - corner.x > 1.0f) {
    list.PushClipRect(corner, {edge, end.y}, true);
    list.AddRectFilled(corner, end, packed(palette.accent.with_alpha(hovered ? 105 : 78)), rounding);
    list.PopClipRect();
  }
  // Low, so that it does not cross the number.
  list.AddLine({edge, end.y - style.points(4)}, {edge, end.y}, packed(palette.accent), style.points(2));
  const ImU32 nothing = packed(palette.raised.with_alpha(0));
  const bool typing = ImGui::TempInputIsActive(ImGui::GetID(label));
  if (!typing)
    for (ImGuiCol slot : {ImGuiCol_FrameBg, ImGuiCol_FrameBgHovered, ImGuiCol_FrameBgActive, ImGuiCol_SliderGrab,
                          ImGuiCol_SliderGrabActive})
      ImGui::PushStyleColor(slot, nothing);
  ImGui::SetNextItemWidth(width);
  ImGui::PushStyleVar(ImGuiStyleVar_GrabMinSize, 1.0f);  // the bar's edge is the grab, and stays under the mouse
  const bool edited = ImGui::SliderFloat(label, &value, minimum, maximum, format, flags);
  ImGui::PopStyleVar();
  if (!typing) ImGui::PopStyleColor(5);
  return edited;
}

bool begin_pane(const char* name, ImVec2 place, ImVec2 size, ImGuiWindowFlags flags) {
  ImGui::SetNextWindowPos(place);
  ImGui::SetNextWindowSize(size);
  return ImGui::Begin(name, nullptr,
                      ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
                          ImGuiWindowFlags_NoBringToFrontOnFocus | ImGuiWindowFlags_NoBackground | flags);
}

void end_pane() { ImGui::End(); }

}  // namespace inkwell::window
