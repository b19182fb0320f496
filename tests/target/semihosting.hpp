// Output and exit of a test image through the debugger interface (Arm, "Semihosting for AArch32 and AArch64").
#pragma once

#include <cstddef>
#include <cstdint>

namespace inkwell::semihosting {

/// Writes a zero-terminated text to the terminal of the simulator.
void write(const char* text);

/// Writes bytes to the terminal.
void write(const char* bytes, std::size_t count);

/// Stops the simulator with this exit code.
[[noreturn]] void exit(int code);

}  // namespace inkwell::semihosting
