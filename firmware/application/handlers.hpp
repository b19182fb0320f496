// Functions that the processor calls.
#pragma once

namespace inkwell::application {

extern "C" {
/// First instruction after a reset.
[[noreturn]] void reset_handler();
/// All faults, the non-maskable interrupt and all unexpected interrupts.
[[noreturn]] void fault_handler();
/// Runs after all other interrupts, on request of drivers::CallBehindInterrupts (PendSV). Records the location of the
/// main loop.
void hang_handler();
/// End of the injected conversions, once per control period.
void control_interrupt();
/// The CPU supply has fallen too low.
void logic_supply_interrupt();
}

}  // namespace inkwell::application
