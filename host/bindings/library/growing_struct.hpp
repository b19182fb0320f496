// Structs of the C interface to which a later library may append members. A program passes the size that it knows.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstring>

#include <fmt/format.h>

#include "host/bindings/library/errors.hpp"

namespace inkwell::library {

/// Checks the size of a program's struct, which may belong to an older or newer library. `first_size` is the size in
/// the first version.
inline void check_size(std::size_t size, std::size_t first_size, const char* type) {
  if (size < first_size) throw BadArgument(fmt::format("The size {} is too small. Give sizeof({}).", size, type));
}

/// Writes the members that the program's struct has. Members of newer libraries are set to 0.
template <class Struct>
void copy_members(const Struct& from, Struct* to, std::size_t size) {
  std::memset(static_cast<void*>(to), 0, size);
  std::memcpy(static_cast<void*>(to), &from, std::min(size, sizeof from));
}

/// Does the same for element `index` of a program's array whose elements have this size.
template <class Struct>
void copy_element(const Struct& from, Struct* array, std::size_t index, std::size_t size) {
  copy_members(from, reinterpret_cast<Struct*>(reinterpret_cast<std::byte*>(array) + index * size), size);
}

/// Returns the members that the program's struct has. The other members are 0.
template <class Struct>
Struct read_members(const Struct* from, std::size_t size) {
  Struct whole{};
  std::memcpy(static_cast<void*>(&whole), from, std::min(size, sizeof whole));
  return whole;
}

/// Element `index` of a program's array whose elements have this size.
template <class Struct>
Struct element(const Struct* array, std::size_t index, std::size_t size) {
  return read_members(reinterpret_cast<const Struct*>(reinterpret_cast<const std::byte*>(array) + index * size), size);
}

}  // namespace inkwell::library
