// Real-time scheduling of the library's threads.
#pragma once

#include <pthread.h>
#include <sched.h>

#include <cerrno>
#include <cstring>
#include <mutex>
#include <thread>

#include <fmt/format.h>

#include "host/client/device/error.hpp"

namespace inkwell::library {

/// Replaces the new mutex by one with priority inheritance: a thread that owns the mutex runs with the priority of the
/// waiting thread. Call this function before any thread uses the mutex.
inline void inherit_priority(std::mutex& mutex) {
  pthread_mutexattr_t attributes;
  pthread_mutexattr_init(&attributes);
  pthread_mutexattr_setprotocol(&attributes, PTHREAD_PRIO_INHERIT);
  pthread_mutex_init(mutex.native_handle(), &attributes);
  pthread_mutexattr_destroy(&attributes);
}

/// Schedules the thread with SCHED_FIFO, or normally if the priority is 0. Throws NoPermission or Error.
inline void set_priority(std::thread& thread, int priority) {
  if (!thread.joinable()) return;
  const sched_param parameters{.sched_priority = priority};
  const int reason =
      pthread_setschedparam(thread.native_handle(), priority > 0 ? SCHED_FIFO : SCHED_OTHER, &parameters);
  if (reason == EPERM)
    throw device::NoPermission(
        "You have no permission for real-time priorities. Write `@GROUP - rtprio 80` into a file in "
        "/etc/security/limits.d with a group of yours, and log in again.");
  if (reason != 0)
    throw device::Error(
        fmt::format("The priority {} was not set ({}). Choose another priority.", priority, std::strerror(reason)));
}

}  // namespace inkwell::library
