// The clock tree: crystal, PLL, buses, flash (RM0090, chapters RCC and Embedded flash).
#pragma once

#include <cstdint>

namespace inkwell::drivers {

/// Clock of the processor before start_clocks(), and after it if it failed (RM0090, HSI).
inline constexpr std::uint32_t internal_oscillator_Hz = 16'000'000;

/// Brings the processor from the internal 16 MHz oscillator to the board's clocks, with the accelerator of the
/// flash on and the crystal supervised: if it stops later, the chip raises the non-maskable interrupt.
/// False if the crystal or the PLL does not start within a tenth of a second; the chip then stays at 16 MHz.
[[nodiscard]] bool start_clocks();

/// After a start_clocks() that failed: the crystal, which is still being started.
bool crystal_swings();

}  // namespace inkwell::drivers
