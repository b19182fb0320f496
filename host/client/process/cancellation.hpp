// Support for program threads that are canceled with pthread_cancel() during a library call. A canceled thread unwinds
// its stack from a system call. Most of this code does not support unwinding.
#pragma once

#include <pthread.h>

#include <utility>

namespace inkwell::process {

namespace detail {
/// Cancel state of the calling thread before the outermost guard; undefined without a guard.
inline thread_local int state_of_caller = PTHREAD_CANCEL_DISABLE;
inline thread_local int guards = 0;
}  // namespace detail

/// During its lifetime, the calling thread is canceled only at a CancellationPoint. Every function of an interface
/// starts with a guard.
class CancellationGuard {
 public:
  CancellationGuard() {
    pthread_setcancelstate(PTHREAD_CANCEL_DISABLE, &state_);
    if (detail::guards++ == 0) detail::state_of_caller = state_;
  }
  ~CancellationGuard() {
    --detail::guards;
    pthread_setcancelstate(state_, nullptr);
  }
  CancellationGuard(const CancellationGuard&) = delete;
  CancellationGuard& operator=(const CancellationGuard&) = delete;

 private:
  int state_ = PTHREAD_CANCEL_DISABLE;
};

/// Surrounds a wait. During the wait the thread is canceled if the program allows cancellation. Every frame between
/// this object and the interface function must unwind, so no frame is noexcept, and each `catch (...)` rethrows a
/// cancellation.
class CancellationPoint {
 public:
  CancellationPoint() {
    if (detail::guards > 0) pthread_setcancelstate(detail::state_of_caller, nullptr);
  }
  ~CancellationPoint() {
    if (detail::guards > 0) pthread_setcancelstate(PTHREAD_CANCEL_DISABLE, nullptr);
  }
  CancellationPoint(const CancellationPoint&) = delete;
  CancellationPoint& operator=(const CancellationPoint&) = delete;
};

/// During its lifetime, no CancellationPoint allows cancellation. Use this class in destructors, because destructors
/// must not unwind.
class NoCancellationPoints {
 public:
  NoCancellationPoints() : state_(std::exchange(detail::state_of_caller, PTHREAD_CANCEL_DISABLE)) {}
  ~NoCancellationPoints() { detail::state_of_caller = state_; }
  NoCancellationPoints(const NoCancellationPoints&) = delete;
  NoCancellationPoints& operator=(const NoCancellationPoints&) = delete;

 private:
  int state_;
};

/// Call this in library threads before functions of the program.
inline void never_cancel_this_thread() { pthread_setcancelstate(PTHREAD_CANCEL_DISABLE, nullptr); }

}  // namespace inkwell::process
