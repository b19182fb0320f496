// The threads that keep a device's sign of life must run in time however busy the computer is.
#pragma once

#include <sys/resource.h>
#include <unistd.h>

namespace inkwell::device {

/// Asks that the calling thread goes before others. Without the permission for it, it stays as it is.
inline void ask_for_precedence() {
  constexpr int precedence = -10;
  setpriority(PRIO_PROCESS, static_cast<id_t>(gettid()), precedence);
}

}  // namespace inkwell::device
