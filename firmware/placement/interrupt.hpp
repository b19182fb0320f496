// Memory location of interrupt code.
#pragma once

/// Every function that runs in an interrupt needs this mark before its definition. The mark places the function in the
/// section .interrupt_text (boards/facts/stm32f405.ld). Start-up copies .interrupt_text to RAM. The tool
/// tools/check/check_image.py rejects interrupts that call code outside .interrupt_text. The tool rejects functions in
/// .interrupt_text that no interrupt calls. All code of firmware/control is in .interrupt_text and needs no marks. On a
/// PC the mark has no effect.
#if defined(__arm__)
// Each function has a separate section, so that the linker can omit unused functions.
#define INKWELL_INTERRUPT_SECTION(number) ".text.interrupt." #number
#define INKWELL_INTERRUPT_NUMBERED(number) [[gnu::section(INKWELL_INTERRUPT_SECTION(number))]]
#define INKWELL_INTERRUPT INKWELL_INTERRUPT_NUMBERED(__COUNTER__)
#else
#define INKWELL_INTERRUPT
#endif
