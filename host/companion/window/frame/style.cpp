#include "host/companion/window/frame/style.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>

#include <imgui_freetype.h>

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

// Unicode ranges of Latin letters, Greek letters, punctuation, arrows and marks.
constexpr ImWchar glyph_ranges[] = {0x0020, 0x00FF, 0x0370, 0x03FF, 0x2010, 0x2026, 0x2190, 0x2193, 0x21B6,
                                    0x21BB, 0x2212, 0x2212, 0x25A0, 0x25CF, 0x2713, 0x2717, 0};

ImFont* add_font(const char* file, float pixels) {
  ImFontConfig configuration;
  configuration.OversampleH = 1;
  configuration.PixelSnapH = true;
  return ImGui::GetIO().Fonts->AddFontFromFileTTF(file, pixels, &configuration, glyph_ranges);
}

// Sets the same width for all digits, so that a changing number does not move adjacent text.
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
  set(ImGuiCol_WindowBg, palette.pane);
  set(ImGuiCol_ChildBg, palette.pane.with_alpha(0));
  set(ImGuiCol_PopupBg, palette.pane);
  set(ImGuiCol_Border, palette.line);
  set(ImGuiCol_FrameBg, palette.raised);
  set(ImGuiCol_FrameBgHovered, palette.raised_hover);
  set(ImGuiCol_FrameBgActive, palette.raised_active);
  set(ImGuiCol_ScrollbarBg, palette.pane.with_alpha(0));
  set(ImGuiCol_ScrollbarGrab, palette.raised);
  set(ImGuiCol_ScrollbarGrabHovered, palette.raised_hover);
  set(ImGuiCol_ScrollbarGrabActive, palette.raised_active);
  set(ImGuiCol_CheckMark, palette.accent);
  set(ImGuiCol_SliderGrab, palette.accent);
  set(ImGuiCol_SliderGrabActive, palette.accent);
  set(ImGuiCol_Button, palette.raised);
  set(ImGuiCol_ButtonHovered, palette.raised_hover);
  set(ImGuiCol_ButtonActive, palette.raised_active);
  set(ImGuiCol_Header, palette.pane.with_alpha(0));
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

}  // namespace inkwell::window
