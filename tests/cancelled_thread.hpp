// Runs a call in a thread and cancels this thread.
#pragma once

#include <doctest/doctest.h>

#include <pthread.h>
#include <time.h>

#include <atomic>
#include <functional>
#include <utility>

namespace inkwell::tests {

class CancelledThread {
 public:
  explicit CancelledThread(std::function<void()> call) : call_(std::move(call)) {
    pthread_create(&thread_, nullptr, &CancelledThread::run, this);
    while (!is_in_) sched_yield();
  }
  /// Cancels the thread. Returns true if the thread ends within a minute.
  bool ends_when_cancelled() {
    pthread_cancel(thread_);
    timespec until{};
    clock_gettime(CLOCK_REALTIME, &until);
    until.tv_sec += 60;
    void* result = nullptr;
    REQUIRE_MESSAGE(pthread_timedjoin_np(thread_, &result, &until) == 0, "the cancelled thread hangs");
    return result == PTHREAD_CANCELED;
  }

 private:
  static void* run(void* self) {
    auto& me = *static_cast<CancelledThread*>(self);
    me.is_in_ = true;
    me.call_();
    return nullptr;
  }

  std::function<void()> call_;
  pthread_t thread_{};
  std::atomic<bool> is_in_ = false;
};

}  // namespace inkwell::tests
