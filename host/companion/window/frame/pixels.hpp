// A part of the drawn window.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace inkwell::window {

/// Rows from bottom to top, with three bytes per pixel.
struct Pixels {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> rgb;
};

/// Writes a PNG file. Returns an error message; empty on success. Any thread may call this function.
std::string write_png(const std::filesystem::path& file, const Pixels& pixels);

}  // namespace inkwell::window
