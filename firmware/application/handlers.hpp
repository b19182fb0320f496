// Handlers of resets, CPU faults and interrupts.
#pragma once

namespace inkwell::application {

extern "C" {
/// Contains the first instruction after a reset.
[[noreturn]] void reset_handler();
/// Handles all CPU faults, the non-maskable interrupt and all unexpected interrupts.
[[noreturn]] void cpu_fault_handler();
/// PendSV handler, with the lowest priority of all interrupts. Records the code location of the main loop. The function
/// drivers::CallAfterInterrupts::request() requests this handler.
void hang_handler();
/// Runs once per control period, at the end of the injected conversions.
void control_interrupt();
/// Runs when the CPU supply falls below its limit.
void logic_supply_interrupt();
}

}  // namespace inkwell::application
