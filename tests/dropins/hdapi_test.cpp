// libHD.so as programs use it that were linked against it, on a virtual board.
#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "board.hpp"
#include "hdapi.hpp"

namespace inkwell::tests {
namespace {

/// The newest error, of which there is to be no other.
HDerror only_error() {
  const auto error = hdGetError();
  CHECK(hdGetError().errorCode == HD_SUCCESS);
  return error.errorCode;
}

bool says(HDerror code, const std::string& words) {
  return std::string(hdGetErrorString(code)).find(words) != std::string::npos;
}

/// In the servo thread, tick after tick, until `condition`; false if as many ticks passed before.
bool until(std::function<bool()> condition, int ticks = 20'000) {
  struct State {
    std::function<bool()> condition;
    int left;
    bool reached;
  } state{std::move(condition), ticks, false};
  hdScheduleSynchronous(
      [](void* user) {
        auto& self = *static_cast<State*>(user);
        self.reached = self.condition();
        return self.reached || --self.left <= 0 ? HD_CALLBACK_DONE : HD_CALLBACK_CONTINUE;
      },
      &state, HD_DEFAULT_SCHEDULER_PRIORITY);
  return state.reached;
}

void forget_errors() {
  while (hdGetError().errorCode != HD_SUCCESS) {
  }
}

/// An open device in a hand; the scheduler runs.
struct Held : Board {
  HHD device = hdInitDevice(nullptr);
  Held() {
    REQUIRE_MESSAGE(device != HD_INVALID_HANDLE, std::string(hdGetErrorString(hdGetError().errorCode)));
    hdStartScheduler();
    CHECK(until([] { return hdCheckCalibration() == HD_CALIBRATION_OK; }));
    hold();
    int ticks_at_rest = 0;
    CHECK(until([&] {
      double velocity_mm_per_s[3];
      frame([&] { hdGetDoublev(HD_CURRENT_VELOCITY, velocity_mm_per_s); });
      const bool is_there = std::hypot(pulled_m(0), pulled_m(1), pulled_m(2)) < 0.006;
      const bool rests = std::hypot(velocity_mm_per_s[0], velocity_mm_per_s[1], velocity_mm_per_s[2]) < 5.0;
      ticks_at_rest = is_there && rests ? ticks_at_rest + 1 : 0;
      return ticks_at_rest > 100;
    }));
    for (std::size_t i = 0; i < 3; ++i) rest_m[i] += pulled_m(i);
    forget_errors();
  }
  ~Held() {
    hdStopScheduler();
    hdDisableDevice(device);
    forget_errors();
  }
  template <class Action>
  void frame(Action action) {
    hdBeginFrame(device);
    action();
    hdEndFrame(device);
  }
  /// Frames that ask for the same until the stylus was pulled out of the hand's place so far.
  template <class Action>
  bool pulls(std::size_t axis, double least_m, double most_m, Action action) {
    return until([&, this] {
      frame(action);
      return pulled_m(axis) > least_m && pulled_m(axis) < most_m;
    });
  }
};

void set_force(const std::array<double, 3>& force_N) { hdSetDoublev(HD_CURRENT_FORCE, force_N.data()); }

TEST_CASE("before a device is open: the version, and errors that say what is missing") {
  forget_errors();
  CHECK(std::string(hdGetString(HD_VERSION)).size() > 2);
  CHECK(only_error() == HD_SUCCESS);
  CHECK(hdGetCurrentDevice() == HD_INVALID_HANDLE);
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

TEST_CASE("a device is opened once, by any name, and may be opened again after it was disabled") {
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
  hdGetDoublev(HD_CURRENT_POSITION, position_mm);  // no frame has been yet
  CHECK(position_mm[2] == doctest::Approx(1e3 * board.position_m('z')).epsilon(0.02));
  hdDisableDevice(device);
  CHECK(only_error() == HD_SUCCESS);
  CHECK(hdInitDevice("Left") == 0);
  CHECK(hdGetString(HD_DEVICE_SERIAL_NUMBER) == serial_number);
  hdDisableDevice(0);
  hdDisableDevice(0);
  CHECK(only_error() == HD_BAD_HANDLE);
}

TEST_CASE("frames: begun once, ended once, and the only place to set something") {
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

TEST_CASE("a frame may begin in one callback and end in another of the same tick") {
  Held held;
  struct State {
    HHD device;
    int begun = 0, ended = 0;
  } state{held.device};
  const auto first = hdScheduleAsynchronous(
      [](void* user) {
        hdBeginFrame(static_cast<State*>(user)->device);
        ++static_cast<State*>(user)->begun;
        return HD_CALLBACK_CONTINUE;
      },
      &state, 65535);
  const auto last = hdScheduleAsynchronous(
      [](void* user) {
        hdEndFrame(static_cast<State*>(user)->device);
        return ++static_cast<State*>(user)->ended < 50 ? HD_CALLBACK_CONTINUE : HD_CALLBACK_DONE;
      },
      &state, 0);
  CHECK(first <= 0xFFFFFFFE);
  hdUnschedule(hdWaitForCompletion(last, HD_WAIT_INFINITE) ? first : 0);
  CHECK(state.ended == 50);
  while (const auto error = hdGetError().errorCode)
    CHECK(error == HD_ILLEGAL_BEGIN);  // the first may have been left over
}

TEST_CASE("what a frame sees: the stylus's place, attitude and switches, in HDAPI's units") {
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
  CHECK(transform[10] > 0.5);  // the stylus's back is towards the user
  HDboolean inkwell = 7;
  hdGetBooleanv(HD_CURRENT_INKWELL_SWITCH, &inkwell);
  CHECK(inkwell == 1);
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

TEST_CASE("a force pulls the hand, as much and where it says; a joint torque too; motor values beside it do not") {
  Held held;
  const double ramp_N_per_s[]{100};
  std::array<double, 3> sent_N{};
  CHECK_FALSE(until(
      [&] {
        held.frame([] { set_force({1, 0, 0}); });
        return held.pulled_m(0) > 0.002;
      },
      200));  // is off
  hdEnable(HD_FORCE_OUTPUT);
  CHECK(held.pulls(0, 0.0028, 0.0038, [&] {
    hdSetDoublev(HD_FORCE_RAMPING_RATE, ramp_N_per_s);
    hdGetDoublev(HD_CURRENT_FORCE, sent_N.data());
    CHECK(sent_N[0] == 0.0);
    set_force({9, 9, 9});
    set_force({1, 0, 0});  // the last one counts
  }));
  CHECK(std::abs(held.pulled_m(1)) < 0.001);
  hdGetDoublev(HD_CURRENT_FORCE, sent_N.data());
  CHECK(sent_N[0] == doctest::Approx(1.0));
  CHECK(held.pulls(1, 0.0028, 0.0038, [] { set_force({0, 1, 0}); }));
  double jacobian_mm[36];
  hdGetDoublev(HD_CURRENT_JACOBIAN, jacobian_mm);
  const double pull_z_mNm[3]{jacobian_mm[12], jacobian_mm[13], jacobian_mm[14]};  // 1 N along z
  CHECK(held.pulls(2, 0.0028, 0.0038, [&] {
    set_force({3, 0, 0});
    hdSetDoublev(HD_CURRENT_JOINT_TORQUE, pull_z_mNm);
  }));
  CHECK(only_error() == HD_SUCCESS);
  const long values[3]{1000, 0, 0};
  until([&] {
    held.frame([&] {
      set_force({1, 0, 0});
      hdSetLongv(HD_CURRENT_MOTOR_DAC_VALUES, values);
    });
    return true;
  });
  CHECK(only_error() == HD_FORCE_ERROR);
  CHECK(held.pulls(0, 0.0028, 0.0038, [] { set_force({1, 0, 0}); }));
  hdStopScheduler();
  hdStartScheduler();
  CHECK(held.pulls(0, 0.0028, 0.0038, [] { set_force({1, 0, 0}); }));
}

TEST_CASE("too much force is clamped, or told and dropped") {
  Held held;
  double maximum_N = 0;
  std::array<double, 3> sent_N{};
  hdGetDoublev(HD_NOMINAL_MAX_FORCE, &maximum_N);
  CHECK(maximum_N == doctest::Approx(3.3));
  hdEnable(HD_FORCE_OUTPUT);
  const double ramp_N_per_s[]{1000};
  CHECK(until([&] {
    held.frame([&] {
      hdSetDoublev(HD_FORCE_RAMPING_RATE, ramp_N_per_s);
      set_force({0, 30, 40});
    });
    hdGetDoublev(HD_CURRENT_FORCE, sent_N.data());
    return sent_N[2] > 2.6;
  }));
  CHECK(sent_N[1] == doctest::Approx(0.6 * maximum_N));
  CHECK(sent_N[2] == doctest::Approx(0.8 * maximum_N));
  forget_errors();
  hdDisable(HD_MAX_FORCE_CLAMPING);
  until([&] {
    held.frame([] { set_force({0, 30, 40}); });
    hdGetDoublev(HD_CURRENT_FORCE, sent_N.data());
    return true;
  });
  CHECK(hdGetError().errorCode == 0x201);
  CHECK(sent_N[2] == 0.0);
}

TEST_CASE("a callback that sleeps loses the force, and it comes back") {
  Held held;
  hdEnable(HD_FORCE_OUTPUT);
  CHECK(held.pulls(0, 0.0028, 0.0038, [] { set_force({1, 0, 0}); }));
  until([&] {
    const double begin_s = held.time_s();
    while (held.time_s() < begin_s + 0.4) {
    }
    return true;
  });
  CHECK(std::abs(held.pulled_m(0)) < 0.0015);
  CHECK(held.pulls(0, 0.0028, 0.0038, [] { set_force({1, 0, 0}); }));
}

TEST_CASE("a lost link is an error of communication, and the device may be opened again") {
  Held held;
  held.control.usb(false);
  HDerror error = HD_SUCCESS;
  CHECK(until([&] {
    held.frame([] {});
    error = hdGetError().errorCode;
    return error != HD_SUCCESS;
  }));
  CHECK(error == HD_COMM_ERROR);
  CHECK(says(HD_COMM_ERROR, "HD_COMM_ERROR: "));
  hdStopScheduler();
  hdDisableDevice(held.device);
  held.control.usb(true);
  held.wait_for_device();
  forget_errors();
  CHECK_MESSAGE(hdInitDevice(nullptr) == held.device, std::string(hdGetErrorString(HD_DEVICE_FAULT)));
  hdStartScheduler();
  CHECK(until([&] { return hdCheckCalibration() == HD_CALIBRATION_OK; }));
}

TEST_CASE("the scheduler: order, waiting, taking out, and what is called by the servo thread itself") {
  Held held;
  static std::vector<int> order;
  order.clear();
  const auto note = [](void* user) {
    if (order.size() < 6) order.push_back(*static_cast<int*>(user));
    return HD_CALLBACK_CONTINUE;
  };
  int low = 1, middle = 2, high = 3;
  std::array<HDSchedulerHandle, 3> tasks{};
  until([&] {  // by the servo thread each is called at once, and again in the next tick
    tasks = {hdScheduleAsynchronous(note, &low, 10), hdScheduleAsynchronous(note, &high, 30),
             hdScheduleAsynchronous(note, &middle, 20)};
    return true;
  });
  CHECK(until([] { return order.size() == 6; }));
  CHECK(order == std::vector<int>{1, 3, 2, 3, 2, 1});
  for (const auto task : tasks) {
    CHECK(hdWaitForCompletion(task, HD_WAIT_CHECK_STATUS) == 1);
    hdUnschedule(task);
    CHECK(hdWaitForCompletion(task, HD_WAIT_CHECK_STATUS) == 0);
  }
  CHECK(only_error() == HD_SUCCESS);
  hdUnschedule(tasks[0]);
  CHECK(only_error() == HD_INVALID_OPERATION);
  int calls = 0;
  const auto counts = [](void* user) {
    return ++*static_cast<int*>(user) < 5 ? HD_CALLBACK_CONTINUE : HD_CALLBACK_DONE;
  };
  CHECK(hdWaitForCompletion(hdScheduleAsynchronous(counts, &calls, 5), HD_WAIT_INFINITE) == 1);
  CHECK(calls == 5);
  hdStopScheduler();
  calls = 0;
  const auto waiting = hdScheduleAsynchronous(counts, &calls, 5);
  CHECK(calls == 0);
  hdScheduleSynchronous(counts, &calls, 5);  // nobody else would
  CHECK(calls == 1);
  hdStartScheduler();
  CHECK(hdWaitForCompletion(waiting, HD_WAIT_INFINITE) == 1);
  CHECK(calls == 5);
  hdScheduleAsynchronous(nullptr, nullptr, 5);
  CHECK(only_error() == HD_INVALID_VALUE);
}

TEST_CASE("a tick is a millisecond of the board, or two") {
  Held held;
  int rate_Hz = 0;
  const auto ticks_in_board_time = [&] {
    double begin_s = 0, end_s = 0;
    int ticks = 0;
    begin_s = held.time_s();
    until([&] { return ++ticks == 400; });
    end_s = held.time_s();
    return ticks / (end_s - begin_s);
  };
  CHECK(ticks_in_board_time() < 1'050);
  CHECK(until([&] {
    hdGetIntegerv(HD_INSTANTANEOUS_UPDATE_RATE, &rate_Hz);
    return rate_Hz == 1000;
  }));
  hdSetSchedulerRate(500);
  CHECK(only_error() == HD_SUCCESS);
  CHECK(ticks_in_board_time() < 525);
  double rate = 0;
  hdGetDoublev(HD_UPDATE_RATE, &rate);
  CHECK(rate == 500.0);
  hdSetSchedulerRate(1600);
  CHECK(only_error() == HD_INVALID_VALUE);
  hdSetSchedulerRate(1000);
  CHECK(hdGetSchedulerTimeStamp() >= 0.0);
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
  hdDisableDevice(left);  // the other one paces from now on
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

}  // namespace
}  // namespace inkwell::tests
