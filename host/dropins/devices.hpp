// The devices that the program has open, by handle, and which of them is current.
#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include <process/fork.hpp>

#include "device.hpp"

namespace inkwell::dropins {

/// What a forked child knows of its parent's devices.
struct ParentsDevices {
  int process = 0;
  Handle handles = 0;  ///< those below it may be the parent's
};

class Devices {
 public:
  explicit Devices(const ParentsDevices& parents) : parents_(parents) {}
  /// Without the lock, which a thread may have held that the child does not have.
  ParentsDevices as_parents() const;

  /// Held by every call of the interface while it looks at a device; never while one is opened or closed.
  std::mutex& mutex() { return mutex_; }

  /// Opens the arm that the name stands for and makes it current; raises an error and gives invalid_handle if it can
  /// not. Takes the lock itself.
  Handle open(const char* name);
  /// Takes the lock itself. False if there is no such device.
  bool close(Handle handle);
  void close_all();
  /// Returns once every device has its force off. Takes the lock itself.
  void wait_until_forces_are_off();

  // The following with the lock.

  /// The device under the handle; NULL, and BAD_HANDLE is raised, if there is none.
  Device* find(Handle handle);
  /// What the calling thread made current, so that no other thread's frames take it away; before it made any, what the
  /// program did last.
  Handle current_handle() const;
  Device* current() { return find(current_handle()); }
  /// Keeps the current device open while the lock is released; NULL, and BAD_HANDLE is raised, if there is none.
  std::shared_ptr<Device> hold_current();
  bool make_current(Handle handle);
  /// Only for the calling thread; nothing if there is no such device.
  void make_current_here(Handle handle);
  void set_scheduler_runs(bool runs);
  void renew_forces();
  /// The first device that sends poses, by which the scheduler is paced; none if there is none.
  std::shared_ptr<Device> pacing();

 private:
  bool is_open(Handle handle) const { return handle < devices_.size() && devices_[handle] != nullptr; }
  std::string address_for(const std::string& name) const;

  const ParentsDevices parents_;
  const process::Origin origin_;
  std::atomic<Handle> handles_given_ = 0;  ///< upper bound of the number in use
  std::mutex mutex_, opening_;
  std::vector<std::shared_ptr<Device>> devices_;  ///< by handle; empty places were closed
  Handle current_ = invalid_handle;               ///< for threads that made none current
  bool scheduler_runs_ = false;
};

}  // namespace inkwell::dropins
