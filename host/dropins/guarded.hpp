// No exception leaves the C interfaces.
#pragma once

#include <exception>

#include "errors.hpp"

namespace inkwell::dropins {

template <class Action>
void guarded(Action action) noexcept {
  try {
    action();
  } catch (const std::exception& error) {
    raise(device_fault, invalid_handle, error.what());
  }
}

}  // namespace inkwell::dropins
