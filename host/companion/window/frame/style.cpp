#include "host/companion/window/frame/style.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <filesystem>
#include <thread>
#include <utility>

#include <imgui_freetype.h>

#include "host/companion/window/frame/font_search.hpp"
#include "host/companion/window/frame/imgui_frames.hpp"
#include "host/companion/window/frame/imgui_versions.hpp"

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

/// Characters of a font file, as ranges for ImGui.
struct MoreGlyphs {
  FontChoice font;
  std::vector<ImWchar> ranges;
};

ImFont* add_font(ImFontAtlas& atlas, const char* file, float pixels, const std::vector<MoreGlyphs>& more) {
  ImFontConfig configuration;
  configuration.OversampleH = 1;
  configuration.PixelSnapH = true;
  ImFont* font = atlas.AddFontFromFileTTF(file, pixels, &configuration, glyph_ranges);
  configuration.MergeMode = true;
  for (const MoreGlyphs& each : more) {
    configuration.FontNo = each.font.face;
    atlas.AddFontFromFileTTF(each.font.file.c_str(), pixels, &configuration, each.ranges.data());
  }
  return font;
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

namespace {

/// Returns the main font, or null if no main font is installed.
const FontFiles* main_font() {
  const auto found = std::ranges::find_if(font_files, [](const FontFiles& files) {
    return std::filesystem::exists(files.regular) && std::filesystem::exists(files.strong);
  });
  return found == font_files.end() ? nullptr : &*found;
}

/// Sizes of fonts, in screen units per point and pixels per screen unit.
struct FontScale {
  float units_per_point, pixels_per_unit;
  float pixels(float points) const { return std::round(points * units_per_point * pixels_per_unit); }
};

float display_pixels_per_unit() { return ImGui::GetIO().DisplayFramebufferScale.x; }

/// Converts the measures of a font from pixels to screen units. The texture is unchanged.
void use_screen_units(ImFont* font, float pixels_per_unit) {
  const float units = 1.0f / pixels_per_unit;
  for (ImFontGlyph& glyph : font->Glyphs)
    for (float* length : {&glyph.X0, &glyph.Y0, &glyph.X1, &glyph.Y1, &glyph.AdvanceX}) *length *= units;
  for (float& advance : font->IndexAdvanceX) advance *= units;
  for (float* length : {&font->FallbackAdvanceX, &font->FontSize, &font->Ascent, &font->Descent}) *length *= units;
  scale_ellipsis(*font, units);
}

/// Fills an empty atlas.
Fonts load_fonts(ImFontAtlas& atlas, const FontScale& scale, const std::vector<MoreGlyphs>& more) {
  atlas.FontBuilderIO = ImGuiFreeType::GetBuilderForFreeType();
  atlas.FontBuilderFlags = ImGuiFreeTypeBuilderFlags_LightHinting;
  const FontFiles* files = main_font();
  if (files == nullptr) {
    ImFontConfig configuration;
    configuration.SizePixels = scale.pixels(13.0f);
    ImFont* only = atlas.AddFontDefault(&configuration);
    atlas.Build();
    use_screen_units(only, scale.pixels_per_unit);
    return {only, only, only};
  }
  const Fonts fonts{add_font(atlas, files->regular, scale.pixels(15.0f), more),
                    add_font(atlas, files->strong, scale.pixels(15.0f), more),
                    add_font(atlas, files->regular, scale.pixels(12.5f), more)};
  atlas.Build();
  for (ImFont* font : {fonts.body, fonts.strong, fonts.caption}) {
    make_digits_tabular(font);
    use_screen_units(font, scale.pixels_per_unit);
  }
  return fonts;
}

std::vector<MoreGlyphs> glyphs_for(const std::vector<Character>& characters) {
  if (characters.empty()) return {};
  std::vector<std::filesystem::path> files = installed_fonts(font_folders());
  if (const FontFiles* main = main_font()) files.insert(files.begin(), main->regular);
  std::vector<MoreGlyphs> more;
  for (FontChoice& choice : fonts_for(characters, files)) {
    std::vector<ImWchar> ranges;
    for (const Character character : choice.characters) ranges.insert(ranges.end(), {character, character});
    ranges.push_back(0);
    more.push_back({std::move(choice), std::move(ranges)});
  }
  return more;
}

}  // namespace

/// A font atlas that a thread prepares.
struct FontLoader::Next {
  ImFontAtlas* atlas = IM_NEW(ImFontAtlas)();
  std::vector<MoreGlyphs> more;  ///< the atlas refers to the ranges
  Fonts fonts{};
  std::atomic<bool> is_ready = false;
  std::jthread thread{};

  ~Next() {
    if (thread.joinable()) thread.join();
    if (atlas != nullptr) IM_DELETE(atlas);
  }
};

FontLoader::FontLoader(float scale) : scale_(scale), pixels_per_unit_(display_pixels_per_unit()) {
  ImFontAtlas& atlas = *ImGui::GetIO().Fonts;
  atlas.Clear();
  fonts_ = load_fonts(atlas, {scale_, pixels_per_unit_}, {});
}

FontLoader::~FontLoader() = default;

bool FontLoader::update() {
  if (!next_) {
    const bool is_same_display = display_pixels_per_unit() == pixels_per_unit_;
    if (needed_count() == tried_count_ && is_same_display) return false;
    pixels_per_unit_ = display_pixels_per_unit();
    tried_count_ = needed_count();
    std::vector<Character> needed = needed_characters();
    std::erase_if(needed, [](Character character) {
      for (const ImWchar* range = glyph_ranges; *range != 0; range += 2)
        if (character >= range[0] && character <= range[1]) return true;
      return false;
    });
    if (is_same_display && (needed.empty() || main_font() == nullptr)) return false;
    next_ = std::make_unique<Next>();
    next_->thread =
        std::jthread([next = next_.get(), characters = std::move(needed), scale = FontScale{scale_, pixels_per_unit_}] {
          next->more = glyphs_for(characters);
          next->fonts = load_fonts(*next->atlas, scale, next->more);
          next->is_ready = true;
        });
    return false;
  }
  if (!next_->is_ready) return false;
  next_->thread.join();
  replace_font_atlas(std::exchange(next_->atlas, nullptr));
  fonts_ = next_->fonts;
  next_.reset();
  return true;
}

std::size_t FontLoader::missing() const {
  return static_cast<std::size_t>(std::ranges::count_if(needed_characters(), [this](Character character) {
    return fonts_.body->FindGlyphNoFallback(character) == nullptr;
  }));
}

ImVec4 vector(Colour colour) { return ImGui::ColorConvertU32ToFloat4(packed(colour)); }

void apply_theme(const Palette& palette, float scale) {
  ImGuiStyle style;
  style.WindowPadding = {14, 12};
  style.FramePadding = {9, 5};
  style.ItemSpacing = {8, 9};  // with the text height, a row of a list is 24 points high
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
  style.FrameBorderSize = 1;
  style.IndentSpacing = 14;
  style.ScaleAllSizes(scale);
  style.FrameBorderSize = std::max(1.0f, std::round(scale));  // ScaleAllSizes() excludes borders
  style.PopupBorderSize = style.FrameBorderSize;
  style.AntiAliasedLinesUseTex = true;

  const auto set = [&style](ImGuiCol slot, Colour colour) { style.Colors[slot] = vector(colour); };
  set(ImGuiCol_Text, palette.text);
  set(ImGuiCol_TextDisabled, palette.text_quiet);
  set(ImGuiCol_WindowBg, palette.pane);
  set(ImGuiCol_ChildBg, palette.pane.with_alpha(0));
  set(ImGuiCol_PopupBg, palette.pane);
  set(ImGuiCol_Border, palette.outline);
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
