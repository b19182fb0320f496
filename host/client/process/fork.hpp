// Support for a process that forks while library threads run. The child has a copy of everything except the library
// threads. The mutexes of the library threads stay locked. Sockets, files and child processes belong to the parent.
#pragma once

#include <unistd.h>

#include <memory>
#include <mutex>

namespace inkwell::process {

/// The process that created an object. In a forked child the object is an unusable copy.
class Origin {
 public:
  bool is_here() const { return process_ == getpid(); }
  pid_t process() const { return process_; }

 private:
  pid_t process_ = getpid();
};

/// Delays a fork until no other thread owns the mutex, so that the child finds the mutex free and its data complete.
/// The object and the mutex must live until the process ends. A thread that owns this mutex must not lock another mutex
/// of this kind.
class HeldAtFork {
 public:
  explicit HeldAtFork(std::mutex& mutex) : HeldAtFork(&mutex, calls_of<std::mutex>) {}
  explicit HeldAtFork(std::recursive_mutex& mutex) : HeldAtFork(&mutex, calls_of<std::recursive_mutex>) {}
  HeldAtFork(const HeldAtFork&) = delete;
  HeldAtFork& operator=(const HeldAtFork&) = delete;

 private:
  friend struct Forks;
  struct Calls {
    void (*lock)(void*);
    void (*unlock)(void*);
    void (*make_new)(void*);  ///< in the child, whose thread has not locked the mutex
  };
  template <class Mutex>
  static constexpr Calls calls_of{[](void* mutex) { static_cast<Mutex*>(mutex)->lock(); },
                                  [](void* mutex) { static_cast<Mutex*>(mutex)->unlock(); },
                                  [](void* mutex) { std::construct_at(static_cast<Mutex*>(mutex)); }};
  HeldAtFork(void* mutex, const Calls& calls);

  void* const mutex_;
  const Calls calls_;
  HeldAtFork* const next_;
};

/// A descriptor that a forked child must not use. In the child the descriptor refers to /dev/null, so that the child
/// does not keep the parent's file open or write the parent's buffers. Destroy this object before closing the
/// descriptor.
class OwnDescriptor {
 public:
  OwnDescriptor() = default;
  explicit OwnDescriptor(int descriptor);
  ~OwnDescriptor() { forget(); }
  OwnDescriptor(OwnDescriptor&& other) noexcept;
  OwnDescriptor& operator=(OwnDescriptor&& other) noexcept;

  void forget();

 private:
  int descriptor_ = -1;
};

/// Calls `in_child` in every forked child, until the library is unloaded.
void at_fork(void (*in_child)());

}  // namespace inkwell::process
