// Reads pictures that a program wrote, and analyzes their pixels.
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
  std::vector<std::uint8_t> rgb;  ///< rows from top to bottom

  Colour at(std::size_t x, std::size_t y) const {
    const std::size_t i = 3 * (y * width + x);
    return {rgb[i], rgb[i + 1], rgb[i + 2]};
  }
  /// Number of pixels within `tolerance` of the color in each channel.
  std::size_t count(Colour colour, int tolerance) const;
  std::size_t colours() const;
};

/// Throws std::runtime_error if the file is not a PNG.
Image read_png(const std::string& path);

}  // namespace inkwell::tests
