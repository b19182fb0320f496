// Vector table of the processor (RM0090, "Vector table for STM32F405xx").
#pragma once

#include <array>
#include <cstdint>

namespace inkwell::application {

using Handler = void (*)();

struct VectorTable {
  const std::uint32_t* initial_stack;
  std::array<Handler, 15> exceptions;  ///< the first exception is the reset
  std::array<Handler, 82> interrupts;
};

/// The address of the vector table must be a multiple of 512 (PM0214, VTOR).
extern const VectorTable vectors;

}  // namespace inkwell::application
