// Returns the error message of a call; the call must fail.
#pragma once

#include <concepts>
#include <string>
#include <string_view>

namespace inkwell::tests {

/// Returns the message of the `Failure` that the action throws, or an empty string.
template <class Failure>
std::string message_of(const std::invocable auto& action) {
  try {
    action();
  } catch (const Failure& failure) {
    return failure.what();
  }
  return "";
}

inline bool contains(std::string_view text, std::string_view words) {
  return text.find(words) != std::string_view::npos;
}

}  // namespace inkwell::tests
