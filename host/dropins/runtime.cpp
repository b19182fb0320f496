#include "runtime.hpp"

#include <atomic>
#include <chrono>

namespace inkwell::dropins {
namespace {

using namespace std::chrono_literals;

std::atomic<bool> is_used = false;

/// A program may end without a word: its callbacks are called no more, and its force fades.
__attribute__((destructor)) void end() {
  constexpr auto patience = 1s;  // with a callback that does not return
  if (is_used && runtime().scheduler.stop(patience)) runtime().devices.close_all();
}

}  // namespace

Runtime& runtime() {
  static auto& runtime = *new Runtime;
  is_used = true;
  return runtime;
}

}  // namespace inkwell::dropins
