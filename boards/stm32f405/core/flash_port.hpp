// Flash interface for the processor.
#pragma once

#include <cstdint>
#include <optional>

namespace inkwell::virtual_board {

class FlashPort {
 public:
  virtual ~FlashPort() = default;
  /// Handles a processor store to the flash and returns the new contents. Returns nothing (bus fault) if the address is
  /// outside of the flash.
  virtual std::optional<std::uint32_t> program(std::uint32_t address, std::uint32_t value, unsigned size) = 0;
  /// Makes the core wait for the end of the flash operation.
  virtual void hold_up() = 0;
};

}  // namespace inkwell::virtual_board
