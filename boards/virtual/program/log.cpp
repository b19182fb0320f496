#include "boards/virtual/program/log.hpp"

#include <cstdio>

#include <fmt/format.h>

#include "host/client/local/output.hpp"

#include "protocol/plain_text.hpp"

namespace inkwell::virtual_board {

void log_line(const std::string& text) { local::print_error("virtual-board: {}\n", protocol::plain_lines(text)); }

void log_line(Ticks now, const std::string& text) {
  local::print_error("virtual-board: {:.6f} s: {}\n", seconds(now), protocol::plain_lines(text));
}

}  // namespace inkwell::virtual_board
