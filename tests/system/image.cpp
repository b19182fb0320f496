#include "tests/system/image.hpp"

#include <cstdlib>
#include <set>
#include <stdexcept>

#include <png.h>

namespace inkwell::tests {

std::size_t Image::count(Colour colour, int tolerance) const {
  const auto near = [tolerance](std::uint8_t a, std::uint8_t b) { return std::abs(a - b) <= tolerance; };
  std::size_t found = 0;
  for (std::size_t i = 0; i + 2 < rgb.size(); i += 3)
    found += near(rgb[i], colour.red) && near(rgb[i + 1], colour.green) && near(rgb[i + 2], colour.blue);
  return found;
}

std::size_t Image::colours() const {
  std::set<std::uint32_t> seen;
  for (std::size_t i = 0; i + 2 < rgb.size(); i += 3) seen.insert(rgb[i] << 16 | rgb[i + 1] << 8 | rgb[i + 2]);
  return seen.size();
}

Image read_png(const std::string& path) {
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  const auto check = [&](int done) {
    if (!done) throw std::runtime_error(path + ": " + png.message);
  };
  check(png_image_begin_read_from_file(&png, path.c_str()));
  png.format = PNG_FORMAT_RGB;
  Image image{png.width, png.height, std::vector<std::uint8_t>(PNG_IMAGE_SIZE(png))};
  check(png_image_finish_read(&png, nullptr, image.rgb.data(), 0, nullptr));
  return image;
}

}  // namespace inkwell::tests
