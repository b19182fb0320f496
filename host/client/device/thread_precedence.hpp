// Raises the priority of threads that send heartbeats.
#pragma once

#include <sys/resource.h>
#include <unistd.h>

namespace inkwell::device {

/// Raises the priority of the calling thread. Has no effect without permission.
inline void request_priority() {
  constexpr int precedence = -10;
  setpriority(PRIO_PROCESS, static_cast<id_t>(gettid()), precedence);
}

}  // namespace inkwell::device
