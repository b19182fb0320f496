// One word between the main loop and the control interrupt.
#pragma once

#include <atomic>

namespace inkwell::link {

/// A word that one side writes and the other reads, or that one side sets and the other clears.
///
/// There is one core, and the interrupt preempts the main loop but never the other way round. So the
/// processor keeps the order by itself and only the compiler has to be told: what stands before `store`
/// happens before it and what stands after it happens after it; what stands after `load` happens after it. No barrier
/// instruction, no lock, and `load` then `store` is no atomic change: a word has one writer at a time.
template <class T>
class Shared {
  static_assert(std::atomic<T>::is_always_lock_free, "a lock would let the main loop hold up the interrupt");

 public:
  constexpr explicit Shared(T value) : value_(value) {}

  T load() const {
    const T value = value_.load(std::memory_order_relaxed);
    std::atomic_signal_fence(std::memory_order_acquire);
    return value;
  }

  void store(T value) {
    std::atomic_signal_fence(std::memory_order_release);
    value_.store(value, std::memory_order_relaxed);
    std::atomic_signal_fence(std::memory_order_seq_cst);
  }

 private:
  std::atomic<T> value_;
};

}  // namespace inkwell::link
