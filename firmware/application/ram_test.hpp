// RAM test at boot, while only main() uses the RAM.
#pragma once

namespace inkwell::application {

/// Call this function before any interrupt or DMA transfer occurs. The test preserves the RAM contents. The test omits
/// the used stack and the interrupt code. MemoryCheck compares the interrupt code with the flash. The test takes 10 ms.
[[nodiscard]] bool ram_retains_pattern();

}  // namespace inkwell::application
