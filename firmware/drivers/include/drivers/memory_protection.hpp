// Restrictions on memory access (PM0214, section 4.2 "Memory protection unit").
#pragma once

namespace inkwell::drivers {

/// Call this function after the interrupt code and tables have been copied. From then on each of the following accesses
/// raises a CPU fault:
/// - any access through a null pointer, or to the alias that a reset maps to address 0
/// - any access between the end of the flash and the stack, so that a stack overflow is detected
/// - any access to the bit-band alias of the SRAM
/// - a write to the flash, or to the interrupt code and tables in RAM
/// - an instruction fetch from any other part of the SRAM
void protect_memory();

}  // namespace inkwell::drivers
