// HDAPI functions for devices, frames, scheduler, errors and calibration. The functions for parameters and capabilities
// are in hd_state.cpp.
#include "host/bindings/dropins/hd_interface.hpp"

#include <chrono>
#include <system_error>

#include "host/bindings/dropins/errors.hpp"
#include "host/bindings/dropins/guarded.hpp"
#include "host/bindings/dropins/runtime.hpp"

using namespace inkwell::dropins;
namespace process = inkwell::process;

namespace {

/// Time limit of hdStopScheduler() for the running callback.
constexpr auto for_ever = std::chrono::hours(24);

Handle current_handle() {
  const std::lock_guard lock(runtime().devices.mutex());
  return runtime().devices.current_handle();
}

/// Runs a callback for a waiting thread. The callback and the waiting thread use the same current device.
struct ForCaller {
  HdCallback callback;
  void* user;
  Handle current = current_handle();

  static HdEnum call(void* self) {
    auto& me = *static_cast<ForCaller*>(self);
    const Handle servo_thread = current_handle();
    make_current_here(me.current);
    const auto code = me.callback(me.user);
    me.current = current_handle();
    make_current_here(servo_thread);
    return code;
  }
  static void make_current_here(Handle handle) {
    const std::lock_guard lock(runtime().devices.mutex());
    runtime().devices.make_current_here(handle);
  }
};

template <class Action>
void with_device(Handle handle, Action action) {
  guarded([&] {
    const std::lock_guard lock(runtime().devices.mutex());
    if (Device* device = runtime().devices.find(handle)) action(*device);
  });
}

}  // namespace

// ---- devices, frames ---------------------------------------------------------------------------------------

HdHandle hdInitDevice(const char* name) {
  const process::CancellationGuard guard;
  return runtime().devices.open(name);
}

void hdDisableDevice(HdHandle device) {
  guarded([&] { runtime().devices.close(device); });
}

void hdMakeCurrentDevice(HdHandle device) {
  with_device(device, [&](Device&) { runtime().devices.make_current(device); });
}

// Before hdInitDevice(), some programs expect the handle that the first device will get.
HdHandle hdGetCurrentDevice(void) {
  const std::lock_guard lock(runtime().devices.mutex());
  return runtime().devices.current_or_first_handle();
}

void hdBeginFrame(HdHandle handle) {
  with_device(handle, [&](Device& device) {
    runtime().devices.make_current_here(handle);
    device.begin_frame(runtime().scheduler.tick_of_caller());
  });
}

void hdEndFrame(HdHandle handle) {
  with_device(handle, [](Device& device) { device.end_frame(); });
}

// ---- errors ------------------------------------------------------------------------------------------------

HdErrorInfo hdGetError(void) { return take_error(); }
const char* hdGetErrorString(unsigned code) { return error_text(code); }

HdBoolean hdInkwellForgetErrors(HdHandle device) { return forget_errors_of(device, comm_error) ? 1 : 0; }

// ---- scheduler ---------------------------------------------------------------------------------------------

void hdStartScheduler(void) {
  const process::CancellationGuard guard;
  try {
    stop_callbacks_at_exit();
    runtime().scheduler.start();
    const std::lock_guard lock(runtime().devices.mutex());
    runtime().devices.set_scheduler_runs(true);
  } catch (const std::system_error& error) {
    raise(timer_error, current_handle(), error.what());
  }
}

void hdStopScheduler(void) {
  guarded([] {
    {
      const std::lock_guard lock(runtime().devices.mutex());
      runtime().devices.set_scheduler_runs(false);
    }
    runtime().scheduler.stop(for_ever);
    if (!runtime().scheduler.tick_of_caller()) runtime().devices.wait_until_forces_are_off();
  });
}

void hdSetSchedulerRate(unsigned long rate_Hz) {
  if (!runtime().scheduler.set_rate(rate_Hz))
    raise(invalid_value, current_handle(), "The arm sends a thousand poses a second. Set 1000 or 500 Hz.");
}

HdTask hdScheduleAsynchronous(HdCallback callback, void* user, unsigned short priority) {
  if (callback == nullptr) {
    raise(invalid_value, current_handle(), "The callback is NULL. Give one.");
    return invalid_handle;
  }
  const process::CancellationGuard guard;
  const auto task = runtime().scheduler.add(callback, user, priority);
  if (task == invalid_handle) raise(scheduler_full, current_handle());
  return task;
}

void hdScheduleSynchronous(HdCallback callback, void* user, unsigned short priority) {
  if (callback == nullptr) return raise(invalid_value, current_handle(), "The callback is NULL. Give one.");
  const process::CancellationGuard guard;
  ForCaller for_caller{callback, user};
  if (!runtime().scheduler.run_until_done(&ForCaller::call, &for_caller, priority))
    raise(scheduler_full, current_handle());
  ForCaller::make_current_here(for_caller.current);
}

void hdUnschedule(HdTask task) {
  const process::CancellationGuard guard;
  if (!runtime().scheduler.remove(task))
    raise(invalid_operation, current_handle(), "The callback is not scheduled: it is done, or never was.");
}

HdBoolean hdWaitForCompletion(HdTask task, unsigned wait_code) {
  if (wait_code == wait_check_status) return runtime().scheduler.is_listed(task) ? 1 : 0;
  if (wait_code != wait_infinite) {
    raise(invalid_value, current_handle());
    return 0;
  }
  const process::CancellationGuard guard;
  return runtime().scheduler.wait_until_done(task) ? 1 : 0;
}

double hdGetSchedulerTimeStamp(void) { return runtime().scheduler.time_since_tick_s(); }

// ---- calibration -------------------------------------------------------------------------------------------

HdEnum hdCheckCalibration(void) {
  HdEnum answer = calibration_needs_manual_input;
  with_device(current_handle(), [&](Device& device) { answer = device.calibration(); });
  return answer;
}

HdEnum hdCheckCalibrationStyle(void) { return calibration_style_inkwell; }

void hdUpdateCalibration(HdEnum style) {
  // The board references the encoders automatically when the stylus is in the inkwell.
  with_device(current_handle(), [&](Device& device) {
    if (style != calibration_style_inkwell)
      return raise(invalid_enum, device.handle(), "The arm is calibrated by the inkwell. Update that style.");
    if (!runtime().scheduler.runs())
      raise(invalid_operation, device.handle(), "The inkwell calibrates while the scheduler runs. Start it.");
  });
}

void hdUpdateCalibrationMessage(HdEnum style) { hdUpdateCalibration(style); }

// ---- other functions ------------------------------------------------------------------------------------------------

HdBoolean hdDeploymentLicense(const char*, const char*, const char*) { return 1; }
HdBoolean hdScaleGimbalAngles(double, double, double, double[16]) { return 1; }
