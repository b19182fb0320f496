// Tests devices, frames and values of libHD.so with a virtual board.
#include <doctest/doctest.h>

#include <array>
#include <atomic>
#include <cmath>
#include <limits>
#include <string>
#include <thread>

#include "tests/dropins/held.hpp"

namespace inkwell::tests {
namespace {

TEST_CASE("without an open device, the version is available, and other calls set an error") {
  forget_errors();
  CHECK(std::string(hdGetString(HD_VERSION)).size() > 2);
  CHECK(only_error() == HD_SUCCESS);
  CHECK(hdGetCurrentDevice() == 0);  // the handle of the first device, which some programs expect
  double position_mm[3];
  hdGetDoublev(HD_CURRENT_POSITION, position_mm);
  CHECK(only_error() == HD_BAD_HANDLE);
  hdBeginFrame(0);
  CHECK(only_error() == HD_BAD_HANDLE);
  hdDisableDevice(7);
  CHECK(only_error() == HD_BAD_HANDLE);
  hdMakeCurrentDevice(HD_INVALID_HANDLE);
  CHECK(only_error() == HD_BAD_HANDLE);
  hdEnable(0x1234);
  CHECK(only_error() == HD_INVALID_ENUM);
  CHECK(std::string(hdGetErrorString(0x9999)).size() > 5);

  setenv("INKWELL_DEVICE", "usbip:127.0.0.1:1", 1);
  CHECK(hdInitDevice(nullptr) == HD_INVALID_HANDLE);
  CHECK(only_error() == HD_DEVICE_FAULT);
  CHECK(says(HD_DEVICE_FAULT, "127.0.0.1:1"));
  setenv("INKWELL_DEVICE", "no such number", 1);
  CHECK(hdInitDevice("Default Device") == HD_INVALID_HANDLE);
  CHECK(only_error() == HD_DEVICE_FAULT);
  CHECK(says(HD_DEVICE_FAULT, "no such number"));
  unsetenv("INKWELL_DEVICE");
}

TEST_CASE("an unreferenced device reports its calibration state and outputs no force before it rests in the inkwell") {
  Board board({.paused = true});
  forget_errors();
  const HHD device = hdInitDevice(nullptr);
  REQUIRE(device == 0);
  hdEnable(HD_FORCE_OUTPUT);
  hdStartScheduler();
  double sent_N = 0;
  int ticks = 0;
  const auto push = [&] {
    hdBeginFrame(device);
    set_force({1, 0, 0});
    hdEndFrame(device);
    double force_N[3];
    hdGetDoublev(HD_CURRENT_FORCE, force_N);
    sent_N += force_N[0];
    return ++ticks == 100;
  };
  CHECK(until([] { return hdCheckCalibration() == HD_CALIBRATION_NEEDS_MANUAL_INPUT; }));
  CHECK(until(push));
  CHECK(sent_N == 0.0);
  board.control.dock(true);
  CHECK(until([] { return hdCheckCalibration() == HD_CALIBRATION_OK; }));
  CHECK(only_error() == HD_SUCCESS);
  hdStopScheduler();
  hdDisableDevice(device);
}

TEST_CASE("a device with another protocol version is not opened, and the error contains the versions") {
  Board board(next_protocol);
  forget_errors();
  CHECK(hdInitDevice(nullptr) == HD_INVALID_HANDLE);
  CHECK(only_error() == HD_DEVICE_FAULT);
  CHECK(says(HD_DEVICE_FAULT, "uses protocol version"));
}

TEST_CASE("a device can be opened once under any name, and again after it was disabled") {
  Board board;
  forget_errors();
  const HHD device = hdInitDevice(nullptr);
  REQUIRE(device == 0);
  CHECK(hdGetCurrentDevice() == device);
  CHECK(hdIsEnabled(HD_FORCE_OUTPUT) == 0);
  CHECK(hdInitDevice("Default PHANToM") == HD_INVALID_HANDLE);
  CHECK(only_error() == HD_DEVICE_ALREADY_INITIATED);
  CHECK(hdInitDevice(board.address.c_str()) == HD_INVALID_HANDLE);
  CHECK(only_error() == HD_DEVICE_ALREADY_INITIATED);
  const std::string serial_number = hdGetString(HD_DEVICE_SERIAL_NUMBER);
  CHECK(serial_number.size() == 24);
  double position_mm[3]{};
  double references_rad[3]{1, 1, 1};
  hdGetDoublev(HD_JOINT_ANGLE_REFERENCES, references_rad);
  for (const double reference_rad : references_rad) CHECK(reference_rad == 0.0);
  hdGetDoublev(HD_CURRENT_POSITION, position_mm);  // before the first frame
  CHECK(position_mm[2] == doctest::Approx(1e3 * board.position_m('z')).epsilon(0.02));
  hdDisableDevice(device);
  CHECK(only_error() == HD_SUCCESS);
  CHECK(hdInitDevice("Left") == 0);
  CHECK(hdGetString(HD_DEVICE_SERIAL_NUMBER) == serial_number);
  hdEndFrame(0);  // an error that the program never reads
  hdDisableDevice(0);
  CHECK(hdInitDevice("Left") == 0);
  CHECK(only_error() == HD_SUCCESS);
  hdDisableDevice(0);
  hdDisableDevice(0);
  CHECK(only_error() == HD_BAD_HANDLE);
}

TEST_CASE("frames: begun once, ended once, and required to set something") {
  Held held;
  const double none[3]{};
  int buttons = 0;
  const double not_a_number[3]{0, std::numeric_limits<double>::quiet_NaN(), 0};
  const float huge_N[3]{std::numeric_limits<float>::infinity(), 0, 0};
  const long beyond[3]{40'000, 0, 0};
  hdEndFrame(held.device);
  CHECK(only_error() == HD_ILLEGAL_END);
  hdSetDoublev(HD_CURRENT_FORCE, none);
  CHECK(only_error() == HD_FRAME_ERROR);
  hdBeginFrame(held.device);
  hdBeginFrame(held.device);
  CHECK(only_error() == HD_ILLEGAL_BEGIN);
  hdSetDoublev(0x2FFF, none);
  CHECK(only_error() == HD_INVALID_ENUM);
  hdSetIntegerv(HD_CURRENT_FORCE, &buttons);
  CHECK(only_error() == HD_INVALID_INPUT_TYPE);
  hdSetDoublev(HD_CURRENT_POSITION, none);
  CHECK(only_error() == HD_INVALID_OPERATION);
  hdSetDoublev(HD_CURRENT_FORCE, not_a_number);
  CHECK(only_error() == HD_INVALID_VALUE);
  hdSetFloatv(HD_CURRENT_FORCE, huge_N);
  CHECK(only_error() == HD_INVALID_VALUE);
  hdSetLongv(HD_CURRENT_MOTOR_DAC_VALUES, beyond);
  CHECK(only_error() == HD_INVALID_VALUE);
  hdSetDoublev(HD_CURRENT_FORCE, nullptr);
  CHECK(only_error() == HD_INVALID_VALUE);
  hdEndFrame(held.device);
  hdEndFrame(held.device);
  CHECK(only_error() == HD_ILLEGAL_END);
  hdGetIntegerv(HD_CURRENT_POSITION, &buttons);
  CHECK(only_error() == HD_INVALID_INPUT_TYPE);
  hdGetIntegerv(0x2FFF, &buttons);
  CHECK(only_error() == HD_INVALID_ENUM);

  until([&] {
    held.frame([] {});
    held.frame([] {});
    return true;
  });
  CHECK(hdGetError().errorCode == HD_ILLEGAL_END);
  CHECK(hdGetError().errorCode == HD_ILLEGAL_BEGIN);
}

TEST_CASE("what a frame sees: the stylus's position, attitude and switches, in HDAPI's units") {
  Held held;
  double position_mm[3], transform[16], last_mm[3];
  float position_float_mm[3];
  CHECK(until([&] {
    held.frame([&] { hdGetDoublev(HD_CURRENT_POSITION, position_mm); });
    return std::abs(position_mm[0] - 1e3 * held.position_m('x')) < 0.2;
  }));
  for (std::size_t i = 0; i < 3; ++i) CHECK(std::abs(position_mm[i] - 1e3 * held_point_m[i]) < 6.0);
  hdGetFloatv(HD_CURRENT_POSITION, position_float_mm);
  CHECK(position_float_mm[2] == doctest::Approx(position_mm[2]));
  hdGetDoublev(HD_CURRENT_TRANSFORM, transform);
  for (int i = 0; i < 3; ++i) CHECK(transform[12 + i] == position_mm[i]);
  CHECK(transform[15] == 1.0);
  CHECK(std::hypot(transform[0], transform[1], transform[2]) == doctest::Approx(1.0));
  CHECK(transform[10] > 0.5);  // the back of the stylus points toward the user
  HDboolean inkwell = 7;
  hdGetBooleanv(HD_CURRENT_INKWELL_SWITCH, &inkwell);
  CHECK(inkwell == 1);
  HDboolean safety = 7;
  hdGetBooleanv(HD_CURRENT_SAFETY_SWITCH, &safety);
  CHECK(safety == 0);  // with the safety switch on, the force would be off
  held.control.buttons(false, true);
  int buttons = 0, before = 0;
  CHECK(until([&] {
    before = buttons;
    held.frame([&] { hdGetIntegerv(HD_CURRENT_BUTTONS, &buttons); });
    return buttons == 2;
  }));
  int last = 7;
  hdGetIntegerv(HD_LAST_BUTTONS, &last);
  CHECK(last == before);
  std::array<double, 3> seen_mm{};
  until([&] {
    hdGetDoublev(HD_CURRENT_POSITION, seen_mm.data());
    held.frame([&] { hdGetDoublev(HD_LAST_POSITION, last_mm); });
    return true;
  });
  for (std::size_t i = 0; i < 3; ++i) CHECK(last_mm[i] == seen_mm[i]);
  CHECK(only_error() == HD_SUCCESS);
}

TEST_CASE("two devices, with frames of one inside frames of the other") {
  setenv("INKWELL_DEVICE", "virtual", 1);
  forget_errors();
  const HHD left = hdInitDevice("Left"), right = hdInitDevice("Right");
  REQUIRE(left == 0);
  REQUIRE(right == 1);
  const std::string right_number = hdGetString(HD_DEVICE_SERIAL_NUMBER);
  hdMakeCurrentDevice(left);
  CHECK(hdGetString(HD_DEVICE_SERIAL_NUMBER) != right_number);
  hdStartScheduler();
  int rounds = 0;
  CHECK(until([&] {
    const double force_N[3]{0.1, 0, 0};
    hdBeginFrame(left);
    hdBeginFrame(right);
    hdSetDoublev(HD_CURRENT_FORCE, force_N);
    hdEndFrame(left);
    hdEndFrame(right);
    return ++rounds == 100;
  }));
  CHECK(only_error() == HD_SUCCESS);
  hdDisableDevice(left);  // the other device now sets the pace
  CHECK(until([&] {
    hdBeginFrame(right);
    hdEndFrame(right);
    return ++rounds == 200;
  }));
  CHECK(only_error() == HD_SUCCESS);
  hdStopScheduler();
  hdDisableDevice(right);
  unsetenv("INKWELL_DEVICE");
}

TEST_CASE("a thread's current device is not taken away by another thread's frames") {
  setenv("INKWELL_DEVICE", "virtual", 1);
  forget_errors();
  struct State {
    HHD left = hdInitDevice("Left"), right = hdInitDevice("Right");
    std::atomic<int> frames = 0;
  } state;
  hdMakeCurrentDevice(state.left);
  const auto frames = hdScheduleAsynchronous(
      [](void* user) {
        auto& self = *static_cast<State*>(user);
        hdBeginFrame(self.right);
        hdEndFrame(self.right);
        ++self.frames;
        return HD_CALLBACK_CONTINUE;
      },
      &state, HD_DEFAULT_SCHEDULER_PRIORITY);
  hdStartScheduler();
  while (state.frames < 10) CHECK(hdGetCurrentDevice() == state.left);
  std::jthread([&] { CHECK(hdGetCurrentDevice() == state.left); }).join();  // none current in this thread

  // A synchronous callback uses the current device of its calling thread.
  std::array<HHD, 2> seen{};
  CHECK(until([&] {
    seen[0] = hdGetCurrentDevice();
    hdMakeCurrentDevice(state.right);
    return true;
  }));
  CHECK(seen[0] == state.left);
  CHECK(hdGetCurrentDevice() == state.right);
  hdDisableDevice(state.right);
  CHECK(hdGetCurrentDevice() == HD_INVALID_HANDLE);
  hdMakeCurrentDevice(state.left);
  CHECK(hdGetCurrentDevice() == state.left);
  hdUnschedule(frames);
  hdStopScheduler();
  hdDisableDevice(state.left);
  forget_errors();  // errors of frames of the disconnected device
  unsetenv("INKWELL_DEVICE");
}

}  // namespace
}  // namespace inkwell::tests
