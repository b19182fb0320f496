#include "log.hpp"

#include <cstdio>

#include <fmt/format.h>

namespace inkwell::virtual_board {

void log_line(const std::string& text) { fmt::print(stderr, "virtual-board: {}\n", text); }

void log_line(Ticks now, const std::string& text) {
  fmt::print(stderr, "virtual-board: {:.6f} s: {}\n", seconds(now), text);
}

}  // namespace inkwell::virtual_board
