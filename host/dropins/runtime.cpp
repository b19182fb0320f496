#include "runtime.hpp"

#include <atomic>
#include <chrono>
#include <cstdlib>

namespace inkwell::dropins {
namespace {

using namespace std::chrono_literals;

std::atomic<bool> is_used = false;

constexpr auto patience = 1s;  // with a callback that does not return

/// A program may end without a word: its callbacks are called no more, and its force fades.
__attribute__((destructor)) void end() {
  if (is_used && runtime().scheduler.stop(patience)) runtime().devices.close_all();
}

}  // namespace

Runtime& runtime() {
  static auto& runtime = *new Runtime;
  is_used = true;
  return runtime;
}

void stop_callbacks_at_exit() {
  static const bool is_registered = std::atexit([] { runtime().scheduler.stop(patience); }) == 0;
  static_cast<void>(is_registered);
}

}  // namespace inkwell::dropins
