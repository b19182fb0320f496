#pragma once

namespace inkwell::virtual_board {
/// Called once, so that the linker takes unicorn_page_lock.cpp out of the static library.
void link_page_lock();
}  // namespace inkwell::virtual_board
