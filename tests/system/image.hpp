// Pictures that a program wrote, to look at what they show.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace inkwell::tests {

struct Colour {
  std::uint8_t red, green, blue;
};

struct Image {
  std::size_t width = 0;
  std::size_t height = 0;
  std::vector<std::uint8_t> rgb;  ///< rows from the top

  Colour at(std::size_t x, std::size_t y) const {
    const std::size_t i = 3 * (y * width + x);
    return {rgb[i], rgb[i + 1], rgb[i + 2]};
  }
  /// How many pixels are within `tolerance` of the colour in each channel.
  std::size_t count(Colour colour, int tolerance) const;
  /// How many different colours there are.
  std::size_t colours() const;
};

/// Throws std::runtime_error if the file is no PNG.
Image read_png(const std::string& path);

}  // namespace inkwell::tests
