// Start-up before main(): floating-point unit, memory, constructors.
#include <algorithm>
#include <cstring>

#include "firmware/drivers/boot_loader.hpp"
#include "firmware/drivers/memory_protection.hpp"
#include "firmware/drivers/system.hpp"
#include "firmware/registers/peripherals.hpp"

#include "firmware/application/handlers.hpp"
#include "firmware/application/memory.hpp"
#include "firmware/application/parts.hpp"
#include "firmware/application/vectors.hpp"

namespace inkwell::application {
namespace {

void copy(const std::uint32_t* image, std::uint32_t* begin, const std::uint32_t* end) {
  std::copy_n(image, end - begin, begin);
}

/// Returns the address in SRAM1 of a word of interrupt code, whose own address applies after the remapping.
std::uint32_t* in_sram1(const std::uint32_t* remapped) {
  return ram_begin + reinterpret_cast<std::uintptr_t>(remapped) / sizeof(std::uint32_t);
}

}  // namespace

/// The stack is in the core-coupled memory, whose clock runs after a reset. The chip's boot loader leaves the memory
/// clock disabled (RCC_AHB1ENR is 0, AN2606), so the handler enables the clock. Both the boot loader and a reset load
/// the stack pointer.
extern "C" [[gnu::naked]] void reset_handler() {
  asm volatile(
      "ldr r0, =%c[clocks] \n"
      "ldr r1, [r0] \n"
      "orr r1, r1, %[core_coupled] \n"
      "str r1, [r0] \n"
      "ldr r1, [r0] \n"  // erratum "Delay after an RCC peripheral clock enabling"
      "b start \n"
      ".ltorg \n" ::[clocks] "i"(registers::RCC::AHB1ENR::address),
      [core_coupled] "i"(registers::RCC::AHB1ENR::CCMDATARAMEN::mask));
}

extern "C" [[noreturn, gnu::used]] void start() {
  using registers::FPU_CPACR;
  using registers::SCB;
  if (drivers::take_boot_loader_wish()) drivers::enter_boot_loader();
  // The floating-point unit must be enabled before any floating-point instruction and before any interrupt. Lazy saving
  // of floating-point registers is enabled by default (FPCCR).
  constexpr std::uint32_t full_access_to_both = 0b1111;
  FPU_CPACR::CPACR::modify(FPU_CPACR::CPACR::CP(full_access_to_both));
  asm volatile("dsb\n isb" ::: "memory");

  copy(interrupt_text_image, in_sram1(interrupt_text_begin), in_sram1(interrupt_text_end));
  copy(interrupt_tables_image, interrupt_tables_begin, interrupt_tables_end);
  copy(data_image, data_begin, data_end);
  copy(core_coupled_data_image, core_coupled_data_begin, core_coupled_data_end);
  std::fill(zero_begin, zero_end, 0u);
  std::fill(core_coupled_zero_begin, core_coupled_zero_end, 0u);
  std::fill(sram2_zero_begin, sram2_zero_end, 0u);
  std::memcpy(in_sram1(interrupt_vectors), &vectors, sizeof vectors);
  started_by_boot_loader = drivers::read_boot_mode_and_remap_sram1() == drivers::boot_loader_mode;
  // From here on, the processor reads the vector table from RAM.
  SCB::VTOR::write(reinterpret_cast<std::uint32_t>(interrupt_vectors));
  asm volatile("dsb\n isb" ::: "memory");
  drivers::protect_memory();
  // Separate CPU fault handlers are enabled before any interrupt. Without separate handlers, a CPU fault on a damaged
  // stack would lock up the processor.
  SCB::SHCSR::modify(SCB::SHCSR::MEMFAULTENA(1), SCB::SHCSR::BUSFAULTENA(1), SCB::SHCSR::USGFAULTENA(1));
  for (auto constructor = constructors_begin; constructor != constructors_end; ++constructor) (*constructor)();

  asm volatile("bl main");  // C++ does not allow calls of main()
  __builtin_trap();
}

}  // namespace inkwell::application

/// Called when a program calls a pure virtual function. This defect raises a CPU fault.
extern "C" [[noreturn]] void __cxa_pure_virtual() { __builtin_trap(); }
