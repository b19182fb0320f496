// Memory locations. The linker script (boards/facts/stm32f405.ld) defines the symbols of this file.
#pragma once

#include <cstdint>

/// Places an object in the core-coupled memory. The object must be zero-initialized or have a constructor.
#define INKWELL_CORE_COUPLED [[gnu::section(".bss.ccm")]]

/// Places an object in SRAM2, which DMA can access. The object must be zero-initialized or have a constructor.
#define INKWELL_SRAM2 [[gnu::section(".bss.sram2")]]

/// Places an object in core-coupled memory that start-up does not clear. The object must not have a constructor. The
/// contents are undefined after power-on.
#define INKWELL_KEPT_OVER_RESET [[gnu::section(".bss.kept")]]

extern "C" {
extern std::uint32_t stack_bottom[], stack_top[];
extern std::uint32_t core_coupled_end[], ram_begin[], ram_end[], sram2_begin[], sram2_end[];
extern std::uint32_t data_begin[], data_end[], zero_begin[], zero_end[];
extern std::uint32_t core_coupled_data_begin[], core_coupled_data_end[], core_coupled_zero_begin[],
    core_coupled_zero_end[], sram2_zero_begin[], sram2_zero_end[];
extern std::uint32_t interrupt_vectors[], interrupt_text_begin[], interrupt_text_end[], interrupt_tables_begin[],
    interrupt_tables_end[];
extern const std::uint32_t copied_begin[], copied_end[], code_begin[], text_begin[], image_check[];
extern std::uint32_t parameter_store[];  // changed by flash programming, not by compiled stores
extern const std::uint32_t data_image[], core_coupled_data_image[], interrupt_text_image[], interrupt_tables_image[];
extern void (*const constructors_begin[])();
extern void (*const constructors_end[])();
}
