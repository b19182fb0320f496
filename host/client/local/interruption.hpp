// Repeats system calls that a signal has interrupted. A profiler or a timer of the user's program may send signals at
// any time.
#pragma once

#include <algorithm>
#include <cerrno>
#include <chrono>

namespace inkwell::local {

/// Calls `call` until no signal interrupts it, and returns its result. A negative result means a failure, with the
/// reason in errno. Not for connect() of TCP, which continues after an interruption.
template <class Call>
auto repeat_interrupted(const Call& call) {
  for (;;) {
    errno = 0;  // some libraries fail without a reason in errno
    const auto result = call();
    if (result >= 0 || errno != EINTR) return result;
  }
}

/// The same for a call with a time limit. `call` receives the remaining time.
template <class Call>
auto repeat_interrupted(std::chrono::milliseconds limit, const Call& call) {
  const auto deadline = std::chrono::steady_clock::now() + limit;
  return repeat_interrupted([&] {
    const auto rest = std::chrono::ceil<std::chrono::milliseconds>(deadline - std::chrono::steady_clock::now());
    return call(std::clamp(rest, std::chrono::milliseconds(0), limit));
  });
}

}  // namespace inkwell::local
