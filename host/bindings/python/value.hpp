// Lets Python compare, hash, copy and pickle the structs of the C library.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <set>
#include <string>
#include <type_traits>

#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

namespace inkwell::python {

namespace py = pybind11;

template <class Value>
py::object to_python(const Value& value) {
  // Comparison of tuples treats the same object as equal, so the copy of a record with a NaN equals the record.
  if constexpr (std::is_floating_point_v<Value>)
    if (std::isnan(value)) return py::module_::import("math").attr("nan");
  return py::cast(value);
}
template <class Value, std::size_t size>
py::object to_python(const Value (&values)[size]) {
  if constexpr (std::is_same_v<Value, char>) return py::str(static_cast<const char*>(values));
  py::tuple all(size);
  for (std::size_t i = 0; i < size; ++i) all[i] = to_python(values[i]);
  return all;
}

template <class Value>
void from_python(const py::handle& given, Value& value) {
  if constexpr (std::is_same_v<Value, const char*>) {
    static auto& texts = *new std::set<std::string>;  // texts of the library live as long as the program
    value = texts.insert(given.cast<std::string>()).first->c_str();
  } else {
    value = given.cast<Value>();
  }
}
template <class Value, std::size_t size>
void from_python(const py::handle& given, Value (&values)[size]) {
  if constexpr (std::is_same_v<Value, char>) {
    const auto text = given.cast<std::string>();
    if (text.size() >= size) throw py::cast_error();
    std::fill(std::copy(text.begin(), text.end(), values), values + size, '\0');
  } else {
    const auto all = given.cast<std::array<Value, size>>();
    std::copy(all.begin(), all.end(), values);
  }
}

/// Protocols 0 and 1 of pickle cannot copy a class of C++ without this function.
template <class Class>
void reduce_to_state(Class& type) {
  type.def("__reduce__", [](const py::object& self) {
    return py::make_tuple(py::module_::import("copyreg").attr("__newobj__"), py::make_tuple(py::type::of(self)),
                          self.attr("__getstate__")());
  });
}

/// Makes a struct a value in Python. `members` are all members of the struct.
template <class Struct, class... Values>
void make_value(py::class_<Struct>& type, Values Struct::*... members) {
  const auto state_of = [members...](const Struct& self) { return py::make_tuple(to_python(self.*members)...); };
  const auto restore = [members..., name = std::string(py::str(type.attr("__name__")))](const py::tuple& state) {
    Struct self{};
    try {
      if (state.size() != sizeof...(members)) throw py::cast_error();
      std::size_t i = 0;
      (from_python(state[i++], self.*members), ...);
    } catch (const py::cast_error&) {
      throw py::value_error("This " + name +
                            " was stored by another version of the package inkwell. Read it with that version.");
    }
    return self;
  };
  type.def("__hash__", [state_of](const Struct& self) { return py::hash(state_of(self)); })
      .def("__eq__",
           [state_of](const Struct& self, const py::object& other) -> py::object {
             if (!py::isinstance<Struct>(other)) return py::reinterpret_borrow<py::object>(Py_NotImplemented);
             return py::bool_(state_of(self).equal(state_of(other.cast<const Struct&>())));
           })
      .def(py::pickle(state_of, restore));
  reduce_to_state(type);
}

}  // namespace inkwell::python
