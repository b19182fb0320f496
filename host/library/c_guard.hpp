// Every call of the C interface is guarded, so that no exception leaves the library and each ends in a result.
#pragma once

#include <string>

#include <fmt/format.h>

#include "arm.hpp"
#include "errors.hpp"
#include "seen_poses.hpp"

struct inkwell_arm {
  explicit inkwell_arm(const std::string& address) : arm(address) {}
  inkwell::library::Arm arm;
  inkwell::library::SeenPoses seen;
};

namespace inkwell::library {

/// Of the exception that is being handled. Its sentence is the calling thread's inkwell_error_text() from then on.
inkwell_result result_of_exception() noexcept;

template <class Action>
inkwell_result guarded(Action action) noexcept {
  try {
    action();
    return INKWELL_OK;
  } catch (...) {
    return result_of_exception();
  }
}

/// Throws BadArgument if there is none.
template <class Pointer>
Pointer required(Pointer pointer, const char* what) {
  if (pointer == nullptr) throw BadArgument(fmt::format("{} is NULL. Give one.", what));
  return pointer;
}

inline Arm& arm_of(inkwell_arm* arm) { return required(arm, "The arm")->arm; }

}  // namespace inkwell::library
