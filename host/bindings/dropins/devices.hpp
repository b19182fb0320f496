// The open devices and the current device of a program.
#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "host/client/process/fork.hpp"

#include "host/bindings/dropins/device.hpp"

namespace inkwell::dropins {

/// Information for a forked child about its parent's devices.
struct ParentsDevices {
  int process = 0;
  Handle handles = 0;  ///< lower handles may belong to the parent
};

class Devices {
 public:
  explicit Devices(const ParentsDevices& parents) : parents_(parents) {}
  /// Does not lock the mutex, because a thread of the parent process may own the lock.
  ParentsDevices as_parents() const;

  /// Each HDAPI function locks this mutex to use a device.
  std::mutex& mutex() { return mutex_; }

  /// Opens the arm with this name and makes it current. On failure raises an error and returns invalid_handle. Locks
  /// the mutex.
  Handle open(const char* name);
  /// Locks the mutex. Returns false if no device has this handle.
  bool close(Handle handle);
  void close_all();
  /// Returns once the force of every device is off. Locks the mutex.
  void wait_until_forces_are_off();

  // The caller of the following functions must hold the mutex.

  /// Returns NULL and raises BAD_HANDLE if no device has this handle.
  Device* find(Handle handle);
  /// The current device of the calling thread. A thread without a selection uses the device that the program selected
  /// last.
  Handle current_handle() const;
  /// Returns the handle of the first device until a device has been opened, then current_handle().
  Handle current_or_first_handle() const { return handles_used_ == 0 ? 0 : current_handle(); }
  Device* current() { return find(current_handle()); }
  /// The returned pointer keeps the device open while the mutex is unlocked. If there is no current device, returns
  /// NULL and raises BAD_HANDLE.
  std::shared_ptr<Device> hold_current();
  bool make_current(Handle handle);
  /// Selects the device for the calling thread. Has no effect if no device has this handle.
  void make_current_here(Handle handle);
  void set_scheduler_runs(bool runs);
  void renew_forces();
  /// Returns the first device that sends poses, or NULL. The scheduler follows the poses of this device.
  std::shared_ptr<Device> pacing();

 private:
  bool is_open(Handle handle) const { return handle < devices_.size() && devices_[handle] != nullptr; }
  std::string address_for(const std::string& name) const;

  const ParentsDevices parents_;
  const process::Origin origin_;
  std::atomic<Handle> handles_used_ = 0;  ///< upper limit of the used handles
  std::mutex mutex_, opening_;
  std::vector<std::shared_ptr<Device>> devices_;  ///< by handle; empty entries are closed devices
  Handle current_ = invalid_handle;               ///< for threads that have selected none
  bool scheduler_runs_ = false;
};

}  // namespace inkwell::dropins
