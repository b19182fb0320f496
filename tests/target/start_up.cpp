// Start-up code of a test image on a bare Cortex-M4F, and the handler for CPU faults.
#include <cstdint>
#include <cstdlib>

#include "tests/target/semihosting.hpp"

extern "C" {

extern std::uint32_t bss_start, bss_end, stack_top;
void __libc_init_array();
int run_tests();

[[noreturn]] void reset() {
  // Full access to the floating-point unit (PM0214, "CPACR").
  auto& coprocessor_access = *reinterpret_cast<volatile std::uint32_t*>(0xE000ED88);
  coprocessor_access = coprocessor_access | (0xFu << 20);
  asm volatile("dsb\n isb");
  for (std::uint32_t* word = &bss_start; word != &bss_end; ++word) *word = 0;
  __libc_init_array();
  std::exit(run_tests());
}

[[noreturn]] void processor_fault() {
  inkwell::semihosting::write("The test image met a processor fault.\n");
  inkwell::semihosting::exit(99);
}

// The C++ runtime requires this handle for the destructors of static objects.
void* __dso_handle = nullptr;

// __libc_init_array calls these functions. The functions are empty, because all constructors are in the init array.
void _init() {}
void _fini() {}

using Handler = void (*)();
struct VectorTable {
  std::uint32_t* stack;
  Handler handlers[15];
};

[[gnu::section(".vectors"), gnu::used]] const VectorTable vectors{
    &stack_top,
    {reset, processor_fault, processor_fault, processor_fault, processor_fault, processor_fault, processor_fault,
     processor_fault, processor_fault, processor_fault, processor_fault, processor_fault, processor_fault,
     processor_fault, processor_fault}};
}
