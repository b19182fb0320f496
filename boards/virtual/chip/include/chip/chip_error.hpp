#pragma once

#include <stdexcept>

namespace inkwell::virtual_board {

/// An ELF that can not be loaded, or a processor that can not be set up: a sentence that says what to do.
class ChipError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace inkwell::virtual_board
