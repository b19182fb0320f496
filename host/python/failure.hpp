// What the library refuses becomes an exception of the package: each code has a class of its own in inkwell/errors.py.
#pragma once

#include <string>

#include <pybind11/pybind11.h>
#include <inkwell/inkwell.hpp>
#include <process/cancellation.hpp>

namespace inkwell::python {

namespace py = pybind11;

/// Raises the class of inkwell.errors for `result`, which carries the pose if there is one. The interpreter's lock is
/// held.
[[noreturn]] void raise(inkwell_result result, const std::string& sentence, const Pose* last_pose = nullptr);

/// Calls the library without the interpreter's lock; what it refuses is raised.
template <class Call>
void call(Call library_call) {
  inkwell_result result;
  std::string sentence;
  {
    const process::CancellationGuard guard;  // a thread that ends here would never lock the interpreter again
    const py::gil_scoped_release unlocked;
    result = library_call();
    if (result != INKWELL_OK) sentence = inkwell_error_text();
  }
  if (result != INKWELL_OK) raise(result, sentence);
}

}  // namespace inkwell::python
