// The functions that the processor itself calls.
#pragma once

namespace inkwell::application {

extern "C" {
/// First instruction after a reset.
[[noreturn]] void reset_handler();
/// Every fault, the non-maskable interrupt and every interrupt that nobody asked for.
[[noreturn]] void fault_handler();
/// Behind every interrupt, once drivers::CallBehindInterrupts asked for it (PendSV): notes where the main
/// loop is.
void hang_handler();
/// End of the injected conversions: once every control period.
void control_interrupt();
/// The chip's supply has fallen too low.
void logic_supply_interrupt();
}

}  // namespace inkwell::application
