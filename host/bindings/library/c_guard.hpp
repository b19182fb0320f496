// Guards every call of the C interface. Each call returns a result code instead of an exception. Thread cancellation
// takes effect only while a thread waits. A forked child process cannot use the parent's arm.
#pragma once

#include <cxxabi.h>

#include <string>
#include <type_traits>

#include <fmt/format.h>

#include "host/client/process/cancellation.hpp"
#include "host/client/process/fork.hpp"

#include "host/bindings/library/arm.hpp"
#include "host/bindings/library/errors.hpp"
#include "host/bindings/library/seen_poses.hpp"

struct inkwell_arm {
  inkwell_arm(const std::string& address, double timeout_s) : arm(address, timeout_s) {}
  inkwell::library::Arm arm;
  inkwell::library::SeenPoses seen;
  inkwell::process::Origin origin;
};

namespace inkwell::library {

/// Stores the sentence for inkwell_error_text() and returns `result`. Does not allocate memory.
inkwell_result refuse(inkwell_result result, const char* sentence) noexcept;

/// Returns the result code for the current exception. Stores the exception's message for inkwell_error_text().
inkwell_result result_of_exception() noexcept;

/// `action` returns a result code or nothing.
template <class Action>
inkwell_result guarded(Action action) {
  const process::CancellationGuard guard;
  try {
    if constexpr (std::is_same_v<std::invoke_result_t<Action>, inkwell_result>) {
      return action();
    } else {
      action();
      return INKWELL_OK;
    }
  } catch (const abi::__forced_unwind&) {  // the thread was canceled
    throw;
  } catch (...) {
    return result_of_exception();
  }
}

/// Throws BadArgument if the pointer is null.
template <class Pointer>
Pointer required(Pointer pointer, const char* what) {
  if (pointer == nullptr) throw BadArgument(fmt::format("{} is NULL. Pass a valid pointer.", what));
  return pointer;
}

/// Throws NotNow in a forked child process, which has no copy of the arm's threads.
inline Arm& arm_of(inkwell_arm* arm) {
  const auto& origin = required(arm, "The arm")->origin;
  if (origin.is_here()) return arm->arm;
  throw NotNow(fmt::format("The arm was opened by process {}. Open the arm again in this process.", origin.process()));
}

}  // namespace inkwell::library
