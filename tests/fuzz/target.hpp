// Each parser of external data has a fuzz target. A target is one function that accepts
// any bytes. A target may throw only the documented exceptions of its parser.
#pragma once

// A new target needs a function that accepts any bytes and catches only the documented error of the parser. Register
// the function with `Registered` in a file of this folder. Add a row to docs/fuzzing.md. Store each input that broke
// the parser in seeds/TARGET, as raw bytes or as hexadecimal digits with the suffix .hex.

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace inkwell::fuzz {

using Input = std::span<const std::byte>;
using Bytes = std::vector<std::byte>;

struct Target {
  std::string_view name;  ///< also the name of its seed folder
  void (*run)(Input input);
  std::vector<Bytes> (*examples)();  ///< valid inputs that the code itself generates
};

inline std::vector<Target>& targets() {
  static std::vector<Target> all;
  return all;
}

/// Adds a target to the list at program start.
struct Registered {
  using Examples = std::vector<Bytes>();
  static std::vector<Bytes> none() { return {}; }
  Registered(std::string_view name, void (*run)(Input input), Examples* examples = none) {
    targets().push_back({name, run, examples});
  }
};

/// Returns the target with this name, or nullptr.
inline const Target* find(std::string_view name) {
  for (const Target& target : targets())
    if (target.name == name) return &target;
  return nullptr;
}

inline std::string text_of(Input input) { return {reinterpret_cast<const char*>(input.data()), input.size()}; }

inline Bytes bytes_of(std::string_view text) {
  const auto bytes = std::as_bytes(std::span(text));
  return {bytes.begin(), bytes.end()};
}

/// Calls `parse` and accepts an `Error` as a valid result.
template <class Error, class Parse>
void refuse_or_take(Parse parse) {
  try {
    parse();
  } catch (const Error&) {
  }
}

}  // namespace inkwell::fuzz
