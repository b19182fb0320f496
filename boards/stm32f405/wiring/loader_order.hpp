// Orders to the boot loader in the system memory of the chip. The emulated processor executes the orders with realistic
// timing. The virtual board issues the orders and emulates the USB interface of the boot loader.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace inkwell::virtual_board {

struct LoaderOrder {
  enum class Kind : std::uint32_t {
    wait,     ///< ask again after 0.1 ms
    store,    ///< write `word` to `address`, then wait until the flash is idle
    program,  ///< write `data` from `address` on, word by word, with a wait after each word
    go,       ///< start the program at the beginning of the flash
  };
  Kind kind = Kind::wait;
  std::uint32_t address = 0;
  std::uint32_t word = 0;
  std::span<const std::byte> data{};  ///< whole words, 4 KiB at most; copied before the next order is requested
};

}  // namespace inkwell::virtual_board
