// Places in the firmware that the virtual board runs.
#pragma once

#include <cstdint>
#include <string_view>

namespace inkwell::tests {

/// The function or variable whose mangled name has this in it; fails the test unless there is exactly one.
std::uint32_t firmware_symbol(std::string_view name);

/// Where the firmware waits for the reset that it has asked for: "dsb", and a branch back to it.
std::uint32_t endless_loop_address();

}  // namespace inkwell::tests
