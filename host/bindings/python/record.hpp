// Attributes of the C library's structs for Python.
#pragma once

#include <string>
#include <vector>

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

namespace inkwell::python {

namespace py = pybind11;

/// Returns a read-only numpy array that refers to a struct member. The array keeps a reference to the struct.
template <class Struct, std::size_t size>
py::cpp_function array_of(double (Struct::*member)[size], std::vector<py::ssize_t> shape = {size}) {
  return [member, shape](const py::object& self) {
    py::array_t<double> array(shape, self.cast<const Struct&>().*member, self);
    py::detail::array_proxy(array.ptr())->flags &= ~py::detail::npy_api::NPY_ARRAY_WRITEABLE_;
    return array;
  };
}

template <class Struct, std::size_t size>
py::cpp_function text_of(char (Struct::*member)[size]) {
  return [member](const Struct& self) { return std::string(self.*member); };
}
template <class Struct>
py::cpp_function flag_of(int Struct::*member) {
  return [member](const Struct& self) { return self.*member != 0; };
}

/// Describes a record by these attributes.
inline std::string describe_attributes(const py::object& self, const std::vector<const char*>& attributes) {
  std::string text = "<inkwell." + std::string(py::str(py::type::of(self).attr("__name__")));
  for (const char* separator = " "; const char* name : attributes) {
    text += separator + std::string(name) + "=" + std::string(py::repr(self.attr(name)));
    separator = ", ";
  }
  return text + ">";
}

}  // namespace inkwell::python
