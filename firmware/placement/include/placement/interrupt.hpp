// Where the code of the interrupts lies.
#pragma once

/// Before the definition of a function that an interrupt calls: puts it into the image's section .interrupt_text
/// (boards/facts/stm32f405.ld), which start-up copies to RAM. tools/check_image.py refuses an image in which an
/// interrupt leaves that section, or in which a function lies there that no interrupt calls. firmware/control lies
/// there as a whole and needs no marks. On a PC the mark means nothing.
#if defined(__arm__)
// A section for each function, so that the linker can leave out those that were inlined everywhere.
#define INKWELL_INTERRUPT_SECTION(number) ".text.interrupt." #number
#define INKWELL_INTERRUPT_NUMBERED(number) [[gnu::section(INKWELL_INTERRUPT_SECTION(number))]]
#define INKWELL_INTERRUPT INKWELL_INTERRUPT_NUMBERED(__COUNTER__)
#else
#define INKWELL_INTERRUPT
#endif
