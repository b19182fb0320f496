// Restrictions on memory access (PM0214, section 4.2 "Memory protection unit").
#pragma once

namespace inkwell::drivers {

/// Call this function after the interrupt code and tables have been copied. After this call, the following accesses
/// raise a CPU fault. (1) Access through a null pointer, or to the alias of address 0. (2) Access between the end of
/// the flash and the stack, for example after a stack overflow. (3) Access to the bit-band alias of the SRAM. (4)
/// Writes to the flash, or to the interrupt code and tables in RAM. (5) Instruction fetches from the SRAM outside the
/// interrupt code.
void protect_memory();

}  // namespace inkwell::drivers
