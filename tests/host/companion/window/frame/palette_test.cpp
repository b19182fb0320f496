#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "host/companion/window/frame/palette.hpp"

using namespace inkwell::window;

namespace {

/// Relative luminance (WCAG 2.1).
double luminance(Colour colour) {
  const auto linear = [](std::uint8_t part) {
    const double share = part / 255.0;
    return share <= 0.03928 ? share / 12.92 : std::pow((share + 0.055) / 1.055, 2.4);
  };
  return 0.2126 * linear(colour.red) + 0.7152 * linear(colour.green) + 0.0722 * linear(colour.blue);
}

double contrast(Colour a, Colour b) {
  const auto [darker, brighter] = std::minmax({luminance(a), luminance(b)});
  return (brighter + 0.05) / (darker + 0.05);
}

constexpr double contrast_minimum = 4.5;  // for text of any size (WCAG 2.1, 1.4.3)

}  // namespace

TEST_CASE("contrast is computed as the guidelines have it") {
  CHECK(contrast({0, 0, 0}, {255, 255, 255}) == doctest::Approx(21.0));
  CHECK(contrast({118, 118, 118}, {255, 255, 255}) == doctest::Approx(4.54).epsilon(0.002));
}

TEST_CASE("every text can be read on every ground that it stands on, in both themes") {
  for (const Theme theme : {Theme::dark, Theme::light}) {
    CAPTURE(theme == Theme::dark);
    const Palette& colours = palette(theme);
    for (const Colour text :
         {colours.text, colours.text_quiet, colours.accent, colours.good, colours.caution, colours.danger_text})
      for (const Colour ground :
           {colours.pane, colours.raised, colours.raised_hover, colours.sky_top, colours.sky_bottom})
        CHECK(contrast(text, ground) >= contrast_minimum);
    CHECK(contrast(colours.text, colours.raised_active) >= contrast_minimum);
  }
}

TEST_CASE("every coloured button can be read, also under the mouse and pressed") {
  for (const Theme theme : {Theme::dark, Theme::light}) {
    CAPTURE(theme == Theme::dark);
    const Palette& colours = palette(theme);
    for (const int by : {0, hover_lightening, -hover_lightening}) {
      CHECK(contrast(colours.pane, lighter(colours.accent, by)) >= contrast_minimum);
      CHECK(contrast(colours.on_good, lighter(colours.good, by)) >= contrast_minimum);
      CHECK(contrast(colours.on_danger, lighter(colours.danger, by)) >= contrast_minimum);
    }
    CHECK(contrast(colours.on_caution, colours.caution) >= contrast_minimum);
  }
}

TEST_CASE("fields and buttons have an outline that is visible on the pane") {
  constexpr double outline_minimum = 3.0;  // for controls (WCAG 2.1, 1.4.11)
  for (const Theme theme : {Theme::dark, Theme::light}) {
    CAPTURE(theme == Theme::dark);
    const Palette& colours = palette(theme);
    for (const Colour ground : {colours.pane, colours.raised, colours.sky_top})
      CHECK(contrast(colours.outline, ground) >= outline_minimum);
  }
}
