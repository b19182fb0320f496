// Clock tree: crystal, PLL, buses, flash (RM0090, chapters RCC and Embedded flash).
#pragma once

#include <cstdint>

namespace inkwell::drivers {

/// Frequency of the internal oscillator (RM0090, HSI).
inline constexpr std::uint32_t internal_oscillator_Hz = 16'000'000;

/// Switches the processor from the internal 16 MHz oscillator to the board's clocks and enables the flash accelerator.
/// If the crystal stops later, the chip raises the non-maskable interrupt. Returns false if the crystal or the PLL does
/// not start within 0.1 s. After a failure the processor clock remains at 16 MHz.
[[nodiscard]] bool start_clocks();

/// Returns true if the crystal oscillates. After start_clocks() has failed, the crystal may start later.
bool crystal_oscillates();

}  // namespace inkwell::drivers
