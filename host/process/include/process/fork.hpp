// A process that is forked while threads of a library run. The child has a copy of everything but of those threads:
// mutexes that they held stay locked, and sockets, files and child processes belong to the parent.
#pragma once

#include <unistd.h>

#include <memory>
#include <mutex>

namespace inkwell::process {

/// Which process made an object. A forked child that meets it has a copy that it cannot use.
class Origin {
 public:
  bool is_here() const { return process_ == getpid(); }
  pid_t process() const { return process_; }

 private:
  pid_t process_ = getpid();
};

/// Delays a fork until no other thread holds the mutex, so that a child finds the mutex free and its data complete. The
/// object and the mutex live until the process ends. A thread that holds such a mutex does not lock another one.
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
    void (*make_new)(void*);  ///< in the child, whose thread is not the one that has locked it
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

/// A descriptor that a forked child may not use. In the child it refers to /dev/null, so that the child neither keeps
/// the parent's file open nor writes the parent's buffers. The owner of the descriptor destroys this object before it
/// closes the descriptor.
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

/// Calls `in_child` in every forked child. Once the library that it belongs to is unloaded, no more.
void at_fork(void (*in_child)());

}  // namespace inkwell::process
