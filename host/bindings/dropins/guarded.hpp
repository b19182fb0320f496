// No exception leaves the C functions. Thread cancellation takes effect only while a thread waits for the scheduler.
#pragma once

#include <exception>

#include "host/client/process/cancellation.hpp"

#include "host/bindings/dropins/errors.hpp"

namespace inkwell::dropins {

template <class Action>
void guarded(Action action) {
  const process::CancellationGuard guard;
  try {
    action();
  } catch (const std::exception& error) {
    raise(device_fault, invalid_handle, error.what());
  }
}

}  // namespace inkwell::dropins
