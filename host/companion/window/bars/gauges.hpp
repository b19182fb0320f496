// Values in the status bar, with a caption above each value.
#pragma once

#include <string>
#include <vector>

#include "host/companion/window/device_desk/device_desk.hpp"
#include "host/companion/window/frame/style.hpp"

namespace inkwell::window {

struct Gauge {
  const char* caption;
  std::string value;
  Colour colour;
  std::string help;
  bool warns = false;  ///< shown by a symbol and by the color
};

/// Returns all gauges of the status bar.
std::vector<Gauge> gauges_of(const DeviceView& view, const Palette& palette);

void draw_gauge(const Gauge& gauge, ImVec2 corner, ImVec2 size, const Style& style);

}  // namespace inkwell::window
