// Library libhdPhantom.so for CHAI3D 3. For each open device, the library executes one libHD.so frame per tick.
//
// CHAI3D axes: x to the user, y to the right, z up. The axes x, y, z of CHAI3D are the axes z, x, y of HDAPI. CHAI3D's
// units are meters and newtons.
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <cstring>
#include <map>
#include <mutex>
#include <stdexcept>
#include <string>
#include <vector>

#include <inkwell/inkwell.h>
#include "host/client/process/cancellation.hpp"
#include "host/client/process/fork.hpp"

#include "host/bindings/dropins/device_names.hpp"
#include "host/bindings/dropins/hd_interface.hpp"

using namespace inkwell::dropins;
namespace process = inkwell::process;

namespace {

using namespace std::chrono_literals;

constexpr Enum current_buttons = 0x2000, current_position = 0x2050, current_velocity = 0x2051,
               current_transform = 0x2052, usable_workspace = 0x2551, current_force = 0x2700, force_output = 0x4000;
constexpr unsigned short priority = 32767;
constexpr char type_text[] = "PHANTOM Omni";
/// Longest wait for a scheduler tick.
constexpr auto tick_patience = 1s;
/// A force expires after this number of ticks.
constexpr int force_ticks = 100;
constexpr int good = 0, bad = -1;
/// Index of the HDAPI axis for each CHAI3D axis.
constexpr std::size_t hd_axis[3]{2, 0, 1};
constexpr double mm = 1e-3;

struct Seen {
  double position_mm[3]{}, velocity_mm_per_s[3]{}, transform[16]{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  int buttons = 0;
};

struct Phantom {
  Handle handle = invalid_handle;  ///< valid from the first access on
  bool is_enabled = false;         ///< true from hdPhantomOpen() on
  bool is_lost = false;            ///< no poses arrived in the last tick
  unsigned long frames = 0;
  Seen seen{};          ///< last values, also of a closed device
  double force_N[3]{};  ///< in HDAPI axes
  int force_ticks_left = 0;
};

struct Servo {
  std::mutex opening;  ///< serializes opening, closing, starting and stopping
  std::vector<std::string> addresses;
  bool runs = false;
  HdTask task = invalid_handle;

  std::mutex mutex;
  std::condition_variable ticked;
  std::map<int, Phantom> phantoms;
};

std::atomic<Servo*> current = nullptr;

/// A forked child gets a new object, because the open devices belong to the parent process.
Servo& servo() {
  static const bool is_made = [] {
    current = new Servo;
    process::at_fork([] { current = new Servo; });
    return true;
  }();
  static_cast<void>(is_made);
  return *current;
}

void frame(Phantom& phantom) {
  Seen seen{};
  double force_N[3];
  hdBeginFrame(phantom.handle);
  hdGetDoublev(current_position, seen.position_mm);
  hdGetDoublev(current_velocity, seen.velocity_mm_per_s);
  hdGetDoublev(current_transform, seen.transform);
  hdGetIntegerv(current_buttons, &seen.buttons);
  {
    const std::lock_guard lock(servo().mutex);
    phantom.seen = seen;
    if (phantom.force_ticks_left > 0)
      --phantom.force_ticks_left;
    else
      std::fill_n(phantom.force_N, 3, 0.0);
    std::copy_n(phantom.force_N, 3, force_N);
  }
  hdSetDoublev(current_force, force_N);
  hdEndFrame(phantom.handle);
}

unsigned tick(void*) {
  std::vector<Phantom*> open;  // map entries do not move, and a handle is removed only while the servo is stopped
  {
    const std::lock_guard lock(servo().mutex);
    for (auto& [number, phantom] : servo().phantoms)
      if (phantom.is_enabled) open.push_back(&phantom);
  }
  for (auto* phantom : open) frame(*phantom);
  const std::lock_guard lock(servo().mutex);
  for (auto* phantom : open) {
    ++phantom->frames;
    phantom->is_lost = hdInkwellForgetErrors(phantom->handle) != 0;
    if (phantom->is_lost) phantom->force_ticks_left = 0;
  }
  servo().ticked.notify_all();
  return callback_continue;
}

void start_servo() {
  if (servo().runs) return;
  servo().task = hdScheduleAsynchronous(tick, nullptr, priority);
  hdStartScheduler();
  servo().runs = true;
}

void stop_servo() {
  if (!servo().runs) return;
  hdStopScheduler();
  hdUnschedule(servo().task);
  servo().runs = false;
}

/// The arm in INKWELL_DEVICE has the number 0. The other arms have the order of inkwell_list_devices().
void list_arms() {
  std::size_t count = 0;
  if (inkwell_list_devices(nullptr, 0, &count) != INKWELL_OK) return;
  std::vector<inkwell_device> arms(count);
  if (inkwell_list_devices(arms.data(), arms.size(), &count) != INKWELL_OK) return;
  arms.resize(std::min(count, arms.size()));
  std::vector<inkwell_named_arm> names;
  try {
    names = list_names();
  } catch (const std::runtime_error&) {  // hdPhantomOpen() reports the damaged file
  }
  const std::string first = configured_arm(names).address;
  std::stable_partition(arms.begin(), arms.end(), [&](const auto& arm) { return first == arm.address; });
  servo().addresses.clear();
  for (const auto& arm : arms) servo().addresses.emplace_back(arm.address);
}

bool look_up_number(int number) {
  if (servo().addresses.empty()) list_arms();
  return number >= 0 && static_cast<std::size_t>(number) < servo().addresses.size();
}

/// Opens the device if necessary. Returns NULL on failure.
Phantom* reach(int number) {
  if (!look_up_number(number)) return nullptr;
  if (const auto found = servo().phantoms.find(number);
      found != servo().phantoms.end() && found->second.handle != invalid_handle)
    return &found->second;
  const auto handle = hdInitDevice(servo().addresses[static_cast<std::size_t>(number)].c_str());
  if (handle == invalid_handle) return nullptr;
  const std::lock_guard lock(servo().mutex);
  auto& phantom = servo().phantoms[number];
  phantom.handle = handle;
  return &phantom;
}

/// Starts the servo. Returns false if the device is not open.
bool start_servo_if_open(int number) {
  const std::lock_guard opening(servo().opening);
  const auto found = servo().phantoms.find(number);
  if (found == servo().phantoms.end() || !found->second.is_enabled) return false;
  start_servo();
  return true;
}

/// Passes the last values to `write` even on failure, because some programs ignore the result. Returns -1 if the values
/// are outdated.
template <class Write>
int read(int number, Write write) {
  const process::CancellationGuard guard;
  bool sees = start_servo_if_open(number);
  std::unique_lock lock(servo().mutex);
  const auto found = servo().phantoms.find(number);
  if (found == servo().phantoms.end()) {
    write(Seen());
    return bad;
  }
  const Phantom& phantom = found->second;
  const auto has_frames = [&] { return phantom.frames > 0; };
  sees = sees && servo().ticked.wait_for(lock, tick_patience, has_frames) && !phantom.is_lost;
  const int result = write(phantom.seen);
  return sees ? result : bad;
}

/// Calls `set` and waits for the next tick, which uses the new values. Returns -1 and does not call `set` if the device
/// is lost or not open.
template <class Set>
int set_until_next_tick(int number, Set set) {
  const process::CancellationGuard guard;
  if (!start_servo_if_open(number)) return bad;
  std::unique_lock lock(servo().mutex);
  Phantom& phantom = servo().phantoms.find(number)->second;
  const auto frames = phantom.frames;
  if (!phantom.is_lost) set(phantom);
  const bool ticks = servo().ticked.wait_for(lock, tick_patience, [&] { return phantom.frames != frames; });
  return ticks && !phantom.is_lost ? good : bad;
}

int read_vector(int number, double (Seen::*member)[3], double* x, double* y, double* z) {
  double* const to[3]{x, y, z};
  if (std::find(to, to + 3, nullptr) != to + 3) return bad;
  return read(number, [&](const Seen& seen) {
    for (std::size_t axis = 0; axis < 3; ++axis) *to[axis] = mm * (seen.*member)[hd_axis[axis]];
    return good;
  });
}

bool is_finite(const double* const (&values)[3]) {
  return std::all_of(values, values + 3, [](const double* value) { return value != nullptr && std::isfinite(*value); });
}

}  // namespace

extern "C" {

INKWELL_HD int hdPhantomGetNumDevices(void) {
  const process::CancellationGuard guard;
  const std::lock_guard opening(servo().opening);
  const bool is_open = std::any_of(servo().phantoms.begin(), servo().phantoms.end(),
                                   [](const auto& entry) { return entry.second.handle != invalid_handle; });
  if (!is_open) list_arms();  // the numbers of open devices do not change
  return static_cast<int>(servo().addresses.size());
}

INKWELL_HD int hdPhantomOpen(int number) {
  const process::CancellationGuard guard;
  const std::lock_guard opening(servo().opening);
  Phantom* phantom = reach(number);
  if (phantom == nullptr) return bad;
  hdMakeCurrentDevice(phantom->handle);
  hdEnable(force_output);
  {
    const std::lock_guard lock(servo().mutex);
    phantom->is_enabled = true;
    phantom->frames = 0;
    phantom->force_ticks_left = 0;
  }
  start_servo();
  return number;
}

INKWELL_HD int hdPhantomClose(int number) {
  const process::CancellationGuard guard;
  const std::lock_guard opening(servo().opening);
  const auto found = servo().phantoms.find(number);
  if (found == servo().phantoms.end() || found->second.handle == invalid_handle) return bad;
  const bool ran = servo().runs;
  stop_servo();  // afterwards no frame is open
  hdDisableDevice(found->second.handle);
  const std::lock_guard lock(servo().mutex);
  const Seen seen = found->second.seen;
  found->second = {};
  found->second.seen = seen;
  const bool is_used = std::any_of(servo().phantoms.begin(), servo().phantoms.end(),
                                   [](const auto& entry) { return entry.second.is_enabled; });
  if (ran && is_used) start_servo();
  return good;
}

INKWELL_HD int hdPhantomGetPosition(int number, double* x, double* y, double* z) {
  return read_vector(number, &Seen::position_mm, x, y, z);
}

INKWELL_HD int hdPhantomGetLinearVelocity(int number, double* x, double* y, double* z) {
  return read_vector(number, &Seen::velocity_mm_per_s, x, y, z);
}

INKWELL_HD int hdPhantomGetRotation(int number, double* r00, double* r01, double* r02, double* r10, double* r11,
                                    double* r12, double* r20, double* r21, double* r22) {
  double* const to[9]{r00, r01, r02, r10, r11, r12, r20, r21, r22};
  if (std::find(to, to + 9, nullptr) != to + 9) return bad;
  return read(number, [&](const Seen& seen) {
    for (std::size_t row = 0; row < 3; ++row)
      for (std::size_t column = 0; column < 3; ++column)
        *to[3 * row + column] = seen.transform[4 * hd_axis[column] + hd_axis[row]];
    return good;
  });
}

INKWELL_HD int hdPhantomGetButtons(int number) {
  return read(number, [](const Seen& seen) { return seen.buttons; });
}

INKWELL_HD int hdPhantomSetForce(int number, const double* x, const double* y, const double* z) {
  const double* const force_N[3]{x, y, z};
  if (!is_finite(force_N)) return bad;
  return set_until_next_tick(number, [&](Phantom& phantom) {
    for (std::size_t axis = 0; axis < 3; ++axis) phantom.force_N[hd_axis[axis]] = *force_N[axis];
    phantom.force_ticks_left = force_ticks;
  });
}

/// A torque has no effect, because the gimbal has no motors.
INKWELL_HD int hdPhantomSetTorque(int number, const double* x, const double* y, const double* z) {
  const double* const torque_Nm[3]{x, y, z};
  if (!is_finite(torque_Nm)) return bad;
  return set_until_next_tick(number, [](Phantom&) {});
}

INKWELL_HD int hdPhantomSetForceAndTorque(int number, const double* force_x, const double* force_y,
                                          const double* force_z, const double* torque_x, const double* torque_y,
                                          const double* torque_z) {
  const double* const torque_Nm[3]{torque_x, torque_y, torque_z};
  return is_finite(torque_Nm) ? hdPhantomSetForce(number, force_x, force_y, force_z) : bad;
}

INKWELL_HD int hdPhantomGetWorkspaceRadius(int number, double* radius_m) {
  const process::CancellationGuard guard;
  const std::lock_guard opening(servo().opening);
  Phantom* phantom = radius_m == nullptr ? nullptr : reach(number);
  if (phantom == nullptr) return bad;
  hdMakeCurrentDevice(phantom->handle);
  double box_mm[6]{};
  hdGetDoublev(usable_workspace, box_mm);
  *radius_m = 0.5 * mm * std::hypot(box_mm[3] - box_mm[0], box_mm[4] - box_mm[1], box_mm[5] - box_mm[2]);
  return good;
}

INKWELL_HD int hdPhantomGetType(int number, char* text) {
  const process::CancellationGuard guard;
  const std::lock_guard opening(servo().opening);
  if (text == nullptr || !look_up_number(number)) return bad;
  std::memcpy(text, type_text, sizeof type_text);
  return good;
}

INKWELL_HD void hdPhantomStartServo(void) {
  const process::CancellationGuard guard;
  const std::lock_guard opening(servo().opening);
  start_servo();
}

INKWELL_HD void hdPhantomStopServo(void) {
  const process::CancellationGuard guard;
  const std::lock_guard opening(servo().opening);
  stop_servo();
}

}  // extern "C"
