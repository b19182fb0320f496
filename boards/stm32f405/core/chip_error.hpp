#pragma once

#include <stdexcept>

namespace inkwell::virtual_board {

/// Failure to load an ELF file or to set up the processor. The message states the remedy.
class ChipError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace inkwell::virtual_board
