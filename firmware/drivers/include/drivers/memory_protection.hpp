// What no instruction may do with the chip's memory (PM0214, section 4.2 "Memory protection unit").
#pragma once

namespace inkwell::drivers {

/// From now on a fault: any access by a null pointer, to the alias that a reset maps to address 0, behind the flash
/// (which is below the stack), or to the alias of a bit of the SRAM; a write to the flash or to the code and tables of
/// the interrupts in the SRAM; and an instruction from anywhere else in the SRAM. Call it when these lie where they
/// belong.
void protect_memory();

}  // namespace inkwell::drivers
