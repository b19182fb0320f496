// Semihosting calls (Arm, "Semihosting for AArch32 and AArch64"): console output and exit codes.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>

#include "boards/stm32f405/core/address_space.hpp"

namespace inkwell::virtual_board {

struct SemihostingAnswer {
  std::uint32_t result = 0;
  std::optional<int> exit_code;
  bool known = true;
};

/// `operation` and `parameter` are the values of R0 and R1 at BKPT 0xAB.
SemihostingAnswer semihosting_call(std::uint32_t operation, std::uint32_t parameter, const AddressSpace& memory,
                                   const std::function<void(std::uint8_t)>& console);

}  // namespace inkwell::virtual_board
