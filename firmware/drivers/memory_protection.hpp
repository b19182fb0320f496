// Restrictions on memory access (PM0214, section 4.2 "Memory protection unit").
#pragma once

namespace inkwell::drivers {

/// Call this function after the interrupt code and tables have been copied. After this
/// call, the following accesses raise a CPU fault:
/// - Access through a null pointer, or to the alias of address 0.
/// - Access between the end of the flash and the stack, for example after a stack overflow.
/// - Access to the bit-band alias of the SRAM.
/// - Writes to the flash, or to the interrupt code and tables in RAM.
/// - Instruction fetches from the SRAM outside the interrupt code.
void protect_memory();

}  // namespace inkwell::drivers
