// Threads of a program that end by pthread_cancel() while they call a library. A cancelled thread unwinds its stack
// from within the system call in which it waits, which most of the code here does not expect.
#pragma once

#include <pthread.h>

#include <utility>

namespace inkwell::process {

namespace detail {
/// State of the caller's thread before the outermost guard; meaningless without a guard.
inline thread_local int state_of_caller = PTHREAD_CANCEL_DISABLE;
inline thread_local int guards = 0;
}  // namespace detail

/// While one lives, the calling thread is cancelled only where a CancellationPoint lives. Every function of an
/// interface begins with one.
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

/// Around a wait: the thread is cancelled here if its owner allows it. Every frame between this and the interface's
/// function must unwind: none is noexcept, and each `catch (...)` rethrows a cancellation.
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

/// While one lives, no CancellationPoint lets the thread be cancelled: for destructors, which do not unwind.
class NoCancellationPoints {
 public:
  NoCancellationPoints() : state_(std::exchange(detail::state_of_caller, PTHREAD_CANCEL_DISABLE)) {}
  ~NoCancellationPoints() { detail::state_of_caller = state_; }
  NoCancellationPoints(const NoCancellationPoints&) = delete;
  NoCancellationPoints& operator=(const NoCancellationPoints&) = delete;

 private:
  int state_;
};

/// For a thread of a library that calls functions of the program: its stack is not the program's to unwind.
inline void never_cancel_this_thread() { pthread_setcancelstate(PTHREAD_CANCEL_DISABLE, nullptr); }

}  // namespace inkwell::process
