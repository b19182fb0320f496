#include "boards/stm32f405/memory/memory.hpp"

namespace inkwell::virtual_board {

MemoryBytes::MemoryBytes() : flash(flash_bytes, 0xFF), sram(sram_bytes), ccm(ccm_bytes), system(system_bytes, 0xFF) {}

}  // namespace inkwell::virtual_board
