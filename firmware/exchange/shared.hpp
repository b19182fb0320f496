// One word shared by the main loop and the control interrupt.
#pragma once

#include <atomic>

namespace inkwell::link {

/// Either a word has one writer, or one side sets the word and the other side clears the word.
///
/// The chip has one core. The interrupt preempts the main loop, but the main loop cannot preempt the interrupt. The
/// processor maintains the order of accesses, so only the compiler needs fences. All earlier accesses are complete
/// before `store` writes the word. Accesses after `store` or `load` start when the call has returned.
///
/// No barrier instruction or lock is necessary. `load` followed by `store` is not atomic, so a word must have only one
/// writer at a time.
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
