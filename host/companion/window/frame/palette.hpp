// All colors of the window. The hues are from Okabe and Ito ("Color Universal Design", 2008). People with common color
// deficiencies can distinguish these hues. The window shows no information by hue alone. With
// WindowOptions::flat_colours, the solid parts of the scene (sphere, proxy, wall frames, force arrow) have exactly
// these colors on the screen. Both themes use the same scene colors.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

namespace inkwell::window {

enum class Theme : std::uint8_t { dark, light };

struct Colour {
  std::uint8_t red, green, blue, alpha = 255;
  bool operator==(const Colour&) const = default;

  constexpr Colour with_alpha(std::uint8_t new_alpha) const { return {red, green, blue, new_alpha}; }
};

namespace scene_colours {
inline constexpr Colour probe{230, 159, 0};        ///< the sphere: orange
inline constexpr Colour proxy{86, 180, 233};       ///< the proxy: sky blue
inline constexpr Colour wall_touched{213, 94, 0};  ///< frame and glow of a wall in contact: vermilion
inline constexpr Colour wall_idle{110, 132, 160};  ///< frame and grid of a wall without contact
inline constexpr Colour force{213, 94, 0};         ///< force arrow, in the color of a wall in contact
inline constexpr Colour hand{0, 158, 115};         ///< the simulated hand and its spring: bluish green
inline constexpr Colour object{196, 178, 146};     ///< an object that the hand feels: neutral bone
inline constexpr Colour axis_x{204, 121, 167};     ///< reddish purple
inline constexpr Colour axis_y{0, 158, 115};
inline constexpr Colour axis_z{86, 180, 233};
}  // namespace scene_colours

/// Colors of the scope lines, in drawing order.
inline constexpr std::array<Colour, 6> line_colours_dark{
    {{86, 180, 233}, {230, 159, 0}, {0, 178, 130}, {219, 140, 182}, {240, 228, 66}, {226, 110, 40}}};
inline constexpr std::array<Colour, 6> line_colours_light{
    {{0, 114, 178}, {213, 94, 0}, {0, 140, 102}, {184, 88, 140}, {150, 118, 0}, {60, 60, 70}}};

/// Colors of one theme.
struct Palette {
  Colour ground;  ///< background
  Colour pane;
  Colour raised;  ///< fields, buttons
  Colour raised_hover;
  Colour raised_active;
  Colour line;     ///< between panes
  Colour outline;  ///< around fields and buttons
  Colour text;
  Colour text_quiet;  ///< units, captions
  Colour accent;      ///< active or selected item; its text has the color `pane`
  Colour good;
  Colour on_good;  ///< text on the color `good`
  Colour caution;
  Colour on_caution;
  Colour danger;  ///< fill of STOP only
  Colour on_danger;
  Colour danger_text;  ///< for text on a pane
  Colour plot_grid;
  Colour sky_top;  ///< background of the scene
  Colour sky_bottom;
  Colour floor_line;
  Colour shadow;
  Colour metal;       ///< links of the arm
  Colour metal_dark;  ///< base and joints of the arm
  std::array<Colour, 6> lines;
};

inline constexpr Palette dark_palette{
    .ground = {17, 20, 25},
    .pane = {24, 28, 34},
    .raised = {37, 43, 52},
    .raised_hover = {47, 55, 66},
    .raised_active = {58, 68, 82},
    .line = {44, 51, 61},
    .outline = {112, 122, 136},
    .text = {230, 234, 240},
    .text_quiet = {156, 167, 182},
    .accent = {98, 170, 228},
    .good = {0, 190, 138},
    .on_good = {16, 20, 26},
    .caution = {230, 159, 0},
    .on_caution = {16, 20, 26},
    .danger = {190, 52, 40},
    .on_danger = {255, 255, 255},
    .danger_text = {245, 125, 110},
    .plot_grid = {38, 44, 53},
    .sky_top = {30, 35, 43},
    .sky_bottom = {44, 51, 61},
    .floor_line = {78, 88, 103},
    .shadow = {8, 10, 14, 150},
    .metal = {176, 184, 194},
    .metal_dark = {92, 102, 116},
    .lines = line_colours_dark,
};

inline constexpr Palette light_palette{
    .ground = {226, 230, 235},
    .pane = {246, 247, 249},
    .raised = {228, 232, 237},
    .raised_hover = {217, 223, 230},
    .raised_active = {203, 211, 220},
    .line = {208, 214, 221},
    .outline = {118, 126, 137},
    .text = {27, 33, 41},
    .text_quiet = {80, 90, 103},
    .accent = {14, 88, 150},
    .good = {0, 100, 72},
    .on_good = {255, 255, 255},
    .caution = {128, 74, 0},
    .on_caution = {255, 255, 255},
    .danger = {184, 44, 30},
    .on_danger = {255, 255, 255},
    .danger_text = {176, 38, 26},
    .plot_grid = {229, 233, 238},
    .sky_top = {240, 243, 246},
    .sky_bottom = {216, 222, 229},
    .floor_line = {182, 190, 200},
    .shadow = {40, 48, 60, 80},
    .metal = {150, 159, 170},
    .metal_dark = {92, 101, 113},
    .lines = line_colours_light,
};

/// Returns the color of a hovered or pressed button. A negative `by` makes the color darker.
constexpr Colour lighter(Colour colour, int by) {
  const auto up = [by](std::uint8_t part) { return static_cast<std::uint8_t>(std::clamp(part + by, 0, 255)); };
  return {up(colour.red), up(colour.green), up(colour.blue), colour.alpha};
}
inline constexpr int hover_lightening = 12;

constexpr const Palette& palette(Theme theme) { return theme == Theme::dark ? dark_palette : light_palette; }

}  // namespace inkwell::window
