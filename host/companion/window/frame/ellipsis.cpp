#include "host/companion/window/frame/ellipsis.hpp"

namespace inkwell::window {

namespace {

constexpr std::string_view ellipsis = "\u2026";

bool is_inside_character(char byte) { return (static_cast<unsigned char>(byte) & 0xC0u) == 0x80u; }

/// Returns the number at the end with the space before it, as in "Motor resistance 1"; otherwise an empty text.
std::string_view final_number(std::string_view text) {
  const std::size_t last = text.find_last_not_of("0123456789");
  return last == std::string_view::npos || last + 1 == text.size() || text[last] != ' ' ? "" : text.substr(last);
}

}  // namespace

std::string with_ellipsis(std::string_view text, float room, const std::function<float(std::string_view)>& width_of) {
  if (width_of(text) <= room) return std::string(text);
  for (const std::string_view end : {final_number(text), std::string_view()}) {
    std::string_view begin = text.substr(0, text.size() - end.size());
    // Removing one character at a time is fast enough for short labels.
    while (!begin.empty()) {
      do begin.remove_suffix(1);
      while (!begin.empty() && is_inside_character(begin.data()[begin.size()]));
      while (begin.ends_with(' ')) begin.remove_suffix(1);
      if (std::string shorter = std::string(begin).append(ellipsis).append(end);
          !begin.empty() && width_of(shorter) <= room)
        return shorter;
    }
  }
  return {};
}

}  // namespace inkwell::window
