// The open devices of the program by handle, and the current device.
#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "host/client/process/fork.hpp"

#include "host/bindings/dropins/device.hpp"

namespace inkwell::dropins {

/// A forked child's information about the devices of its parent.
struct ParentsDevices {
  int process = 0;
  Handle handles = 0;  ///< lower handles may belong to the parent
};

class Devices {
 public:
  explicit Devices(const ParentsDevices& parents) : parents_(parents) {}
  /// Does not lock the mutex, because a thread of the parent may have locked it, and this thread does not exist in the
  /// child.
  ParentsDevices as_parents() const;

  /// Every call of the interface locks this mutex while it uses a device, but not while it opens or closes a device.
  std::mutex& mutex() { return mutex_; }

  /// Opens the arm with this name and makes it current. On failure raises an error and returns invalid_handle. Locks
  /// the mutex.
  Handle open(const char* name);
  /// Locks the mutex. False if no device has this handle.
  bool close(Handle handle);
  void close_all();
  /// Returns once the force of every device is off. Locks the mutex.
  void wait_until_forces_are_off();

  // The following functions require the mutex.

  /// The device with this handle. If no device has this handle, returns NULL and raises BAD_HANDLE.
  Device* find(Handle handle);
  /// The current device of the calling thread. If the thread has selected no device, this is the device that the
  /// program selected last.
  Handle current_handle() const;
  Device* current() { return find(current_handle()); }
  /// Keeps the current device open while the mutex is unlocked. If there is no current device, returns NULL and raises
  /// BAD_HANDLE.
  std::shared_ptr<Device> hold_current();
  bool make_current(Handle handle);
  /// Selects the device for the calling thread only. Has no effect if the handle has no device.
  void make_current_here(Handle handle);
  void set_scheduler_runs(bool runs);
  void renew_forces();
  /// Returns the first device that sends poses, or NULL. This device sets the pace of the scheduler.
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
