// Whether the RAM works, looked at once while nothing but main() uses it.
#pragma once

namespace inkwell::application {

/// Before any interrupt and any transfer of the DMA controller. It keeps what lies there, and leaves out the stack in
/// use and the interrupts' code, which the check of the memory compares with the flash. Takes a hundredth of a second.
[[nodiscard]] bool ram_keeps_pattern();

}  // namespace inkwell::application
