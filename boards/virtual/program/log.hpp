// The log of the program on stderr.
#pragma once

#include <string>

#include "boards/stm32f405/core/interfaces.hpp"

namespace inkwell::virtual_board {

void log_line(const std::string& text);
void log_line(Ticks now, const std::string& text);

}  // namespace inkwell::virtual_board
