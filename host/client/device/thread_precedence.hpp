// Raises the priority of the threads that send the sign of life, because these threads must run in time on a busy
// computer.
#pragma once

#include <sys/resource.h>
#include <unistd.h>

namespace inkwell::device {

/// Raises the priority of the calling thread. Without permission the priority does not change.
inline void request_priority() {
  constexpr int precedence = -10;
  setpriority(PRIO_PROCESS, static_cast<id_t>(gettid()), precedence);
}

}  // namespace inkwell::device
