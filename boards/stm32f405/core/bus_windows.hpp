// Address ranges of the registers.
#pragma once

#include <unicorn/unicorn.h>

#include <cstdint>
#include <span>

namespace inkwell::virtual_board {

/// Processor accesses to this address range call `read` or `write` with the bus as last argument. Function pointers are
/// faster here than virtual functions.
struct BusWindow {
  std::uint32_t base, bytes;
  uc_cb_mmio_read_t read;
  uc_cb_mmio_write_t write;
};

struct BusWindows {
  std::span<const BusWindow> list;
  void* bus;
  /// Returns true if a window contains the address.
  bool answer(std::uint32_t address) const {
    for (const BusWindow& window : list)
      if (address - window.base < window.bytes) return true;
    return false;
  }
};

}  // namespace inkwell::virtual_board
