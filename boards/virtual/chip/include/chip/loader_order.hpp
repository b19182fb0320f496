// What the boot loader in the chip's system memory does. The model's loader has hands, which are instructions that the
// processor runs, so that flash, buses and clocks are those of the chip; its head is whoever plays its part on USB.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace inkwell::virtual_board {

struct LoaderOrder {
  enum class Kind : std::uint32_t {
    wait,     ///< ask again in a tenth of a millisecond
    store,    ///< `word` at `address`, and wait until the flash is not busy
    program,  ///< `data` from `address` on, word by word, each waited for
    go,       ///< start the program at the begin of the flash
  };
  Kind kind = Kind::wait;
  std::uint32_t address = 0;
  std::uint32_t word = 0;
  std::span<const std::byte> data{};  ///< whole words, 4 KiB at most; copied before the next order is asked for
};

}  // namespace inkwell::virtual_board
