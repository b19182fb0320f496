// Address windows of the registers.
#pragma once

#include <unicorn/unicorn.h>

#include <cstdint>
#include <span>

namespace inkwell::virtual_board {

/// Address range whose accesses by the processor call `read` and `write` with the bus as last argument. Function
/// pointers instead of a virtual interface keep an access as short as Unicorn allows.
struct BusWindow {
  std::uint32_t base, bytes;
  uc_cb_mmio_read_t read;
  uc_cb_mmio_write_t write;
};

struct BusWindows {
  std::span<const BusWindow> list;
  void* bus;
  /// True if a window contains the address.
  bool answer(std::uint32_t address) const {
    for (const BusWindow& window : list)
      if (address - window.base < window.bytes) return true;
    return false;
  }
};

}  // namespace inkwell::virtual_board
