// The processor's vector table (RM0090, "Vector table for STM32F405xx").
#pragma once

#include <array>
#include <cstdint>

namespace inkwell::application {

using Handler = void (*)();

struct alignas(512) VectorTable {
  const std::uint32_t* initial_stack;
  std::array<Handler, 15> exceptions;  ///< reset is the first
  std::array<Handler, 82> interrupts;
};

extern const VectorTable vectors;

}  // namespace inkwell::application
