// The one device list and the one scheduler of the program.
#pragma once

#include "devices.hpp"
#include "pacer.hpp"
#include "scheduler.hpp"

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

/// Lives until the process ends, because programs call in from their last destructors. A forked child has one of its
/// own: the devices and the servo thread are its parent's.
Runtime& runtime();

/// A program that ends without a word is called no more before its own static objects go. Call it before the scheduler
/// starts: what was made until then lives as long as the callbacks do.
void stop_callbacks_at_exit();

}  // namespace inkwell::dropins
