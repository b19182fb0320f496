// Output and exit of a test image through the debugger interface (Arm, "Semihosting for AArch32 and AArch64").
#pragma once

#include <cstddef>
#include <cstdint>

namespace inkwell::semihosting {

/// Writes text that ends in a zero byte to the terminal of the program that runs the image.
void write(const char* text);

/// Writes bytes to the terminal.
void write(const char* bytes, std::size_t count);

/// Ends the program that runs the image with this exit code.
[[noreturn]] void exit(int code);

}  // namespace inkwell::semihosting
