#include "host/bindings/dropins/runtime.hpp"

#include <atomic>
#include <chrono>
#include <cstdlib>

#include "host/client/process/fork.hpp"

namespace inkwell::dropins {
namespace {

using namespace std::chrono_literals;

std::atomic<Runtime*> current = nullptr;

constexpr auto patience = 1s;  // limit for a callback that does not return

/// Stops the callbacks and fades out the force when the program exits with open devices.
__attribute__((destructor)) void end() {
  if (current != nullptr && runtime().scheduler.stop(patience)) runtime().devices.close_all();
}

}  // namespace

Runtime& runtime() {
  static const bool is_made = [] {
    current = new Runtime;
    process::at_fork([] { current = new Runtime(current.load()->devices.as_parents()); });
    return true;
  }();
  static_cast<void>(is_made);
  return *current;
}

void stop_callbacks_at_exit() {
  static const bool is_registered = std::atexit([] { runtime().scheduler.stop(patience); }) == 0;
  static_cast<void>(is_registered);
}

}  // namespace inkwell::dropins
