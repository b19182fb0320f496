// The device list and the scheduler of the program.
#pragma once

#include "host/bindings/dropins/devices.hpp"
#include "host/bindings/dropins/pacer.hpp"
#include "host/bindings/dropins/scheduler.hpp"

namespace inkwell::dropins {

struct Runtime {
  explicit Runtime(const ParentsDevices& parents = {}) : devices(parents) {}

  Devices devices;
  Pacer pacer{devices};
  Scheduler scheduler{[this](std::uint32_t poses, const auto& ends) { return pacer.wait(poses, ends); },
                      [this] {
                        const std::lock_guard lock(devices.mutex());
                        devices.renew_forces();
                      }};
};

/// The object is never destroyed, because destructors of static objects may call the library. A forked child has a
/// separate runtime, because the devices and the servo thread belong to the parent.
Runtime& runtime();

/// Registers a handler that stops the callbacks before the program's static objects are destroyed. The callbacks may
/// use all static objects that were created before this call.
void stop_callbacks_at_exit();

}  // namespace inkwell::dropins
