// What a call that must fail says.
#pragma once

#include <concepts>
#include <string>
#include <string_view>

namespace inkwell::tests {

/// The message of the `Failure` that the action throws; empty if it throws nothing.
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
