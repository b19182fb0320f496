#include "host/companion/window/frame/ellipsis.hpp"

namespace inkwell::window {

namespace {

constexpr std::string_view ellipsis = "\u2026";

bool is_inside_character(char byte) { return (static_cast<unsigned char>(byte) & 0xC0u) == 0x80u; }

}  // namespace

std::string with_ellipsis(std::string_view text, float room, const std::function<float(std::string_view)>& width_of) {
  if (width_of(text) <= room) return std::string(text);
  // Removing one character at a time is fast enough for short labels.
  while (!text.empty()) {
    do text.remove_suffix(1);
    while (!text.empty() && is_inside_character(text.data()[text.size()]));
    while (text.ends_with(' ')) text.remove_suffix(1);
    if (std::string shorter = std::string(text).append(ellipsis); !text.empty() && width_of(shorter) <= room)
      return shorter;
  }
  return {};
}

}  // namespace inkwell::window
