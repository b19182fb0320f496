// Converts library errors into the exceptions of inkwell/errors.py.
#pragma once

#include <string>

#include <pybind11/pybind11.h>
#include <inkwell/inkwell.hpp>
#include "host/client/process/cancellation.hpp"

namespace inkwell::python {

namespace py = pybind11;

/// Raises the exception of inkwell.errors for `result`. The caller must hold the interpreter's lock.
[[noreturn]] void raise(inkwell_result result, const std::string& sentence, const Pose* last_pose = nullptr);

/// Calls the library without the interpreter's lock and raises its errors.
template <class Call>
void call(Call library_call) {
  inkwell_result result;
  std::string sentence;
  {
    const process::CancellationGuard guard;  // a canceled thread would never acquire the interpreter's lock again
    const py::gil_scoped_release unlocked;
    result = library_call();
    if (result != INKWELL_OK) sentence = inkwell_error_text();
  }
  if (result != INKWELL_OK) raise(result, sentence);
}

}  // namespace inkwell::python
