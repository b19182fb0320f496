// Tests the forces of libHD.so: magnitude, limits, and behavior when the program or the link fails.
#include <doctest/doctest.h>

#include <array>
#include <atomic>
#include <cmath>
#include <thread>

#include "host/client/device/device.hpp"

#include "tests/dropins/held.hpp"

namespace inkwell::tests {
namespace {

TEST_CASE("a program force or joint torque pulls the hand, and motor values cause a force error") {
  Held held;
  const double ramp_N_per_s[]{100};
  std::array<double, 3> sent_N{};
  CHECK_FALSE(until(
      [&] {
        held.frame([] { set_force({1, 0, 0}); });
        return held.pulled_m(0) > 0.002;
      },
      200));  // the force output is off
  hdEnable(HD_FORCE_OUTPUT);
  CHECK(held.pulls(0, 0.0028, 0.0038, [&] {
    hdSetDoublev(HD_FORCE_RAMPING_RATE, ramp_N_per_s);
    hdGetDoublev(HD_CURRENT_FORCE, sent_N.data());
    CHECK(sent_N[0] == 0.0);
    set_force({9, 9, 9});
    set_force({1, 0, 0});  // the last call counts
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

TEST_CASE("a force above the maximum is clamped, or is dropped with an error") {
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

TEST_CASE("a stylus that exceeds the velocity limit raises one error and not one error per frame") {
  Held held;
  hdEnable(HD_FORCE_OUTPUT);
  CHECK(held.pulls(0, 0.0028, 0.0038, [] { set_force({1, 0, 0}); }));
  forget_errors();
  held.control.hand_path({{0.0, held.rest_m}, {2.0, {held.rest_m[0] - 0.06, held.rest_m[1], held.rest_m[2]}}});
  const double limit_mm_per_s[]{5};
  int fast_frames = 0, reported_errors = 0;
  CHECK(until([&] {
    double velocity_mm_per_s[3];
    held.frame([&] {
      hdSetDoublev(HD_SOFTWARE_VELOCITY_LIMIT, limit_mm_per_s);
      hdGetDoublev(HD_CURRENT_VELOCITY, velocity_mm_per_s);
      set_force({0.1, 0, 0});
    });
    fast_frames += velocity_mm_per_s[0] < -2 * limit_mm_per_s[0] ? 1 : 0;
    while (const auto error = hdGetError().errorCode) reported_errors += error == HD_EXCEEDED_MAX_VELOCITY ? 1 : 0;
    return fast_frames == 200;
  }));
  CHECK(reported_errors >= 1);
  CHECK(reported_errors < 20);  // near the limit the speed may cross it several times
}

TEST_CASE("a callback that sleeps loses the force, and the force returns afterwards") {
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

TEST_CASE("a force continues until the program sets another force, while ticks and poses continue") {
  Held held;
  hdEnable(HD_FORCE_OUTPUT);
  int frames = 0;
  SUBCASE("set in every second frame") {
    CHECK(held.pulls(0, 0.0028, 0.0038, [&] {
      if (++frames % 2 == 0) set_force({1, 0, 0});
    }));
  }
  SUBCASE("set in every tenth frame") {
    CHECK(held.pulls(0, 0.0028, 0.0038, [&] {
      if (++frames % 10 == 0) set_force({1, 0, 0});
    }));
  }
  SUBCASE("the force is set once, and later frames only read") {
    CHECK(held.pulls(0, 0.0028, 0.0038, [&] {
      double force_N[3];
      hdGetDoublev(HD_CURRENT_FORCE, force_N);
      CHECK(force_N[0] == 0.0);  // programs add to the current force
      if (++frames == 1) set_force({1, 0, 0});
    }));
  }
  SUBCASE("the force is set once, without later frames") {
    CHECK(until([&] {
      if (++frames == 1) held.frame([] { set_force({1, 0, 0}); });
      return held.pulled_m(0) > 0.0028;
    }));
  }
  SUBCASE("set by synchronous calls at 60 Hz, with a reader in each tick") {
    hdDisable(HD_ONE_FRAME_LIMIT);
    const auto reader = hdScheduleAsynchronous(
        [](void* user) {
          double position_mm[3];
          static_cast<Held*>(user)->frame([&] { hdGetDoublev(HD_CURRENT_POSITION, position_mm); });
          return HD_CALLBACK_CONTINUE;
        },
        &held, HD_DEFAULT_SCHEDULER_PRIORITY);
    const double begin_s = held.time_s();
    while (held.pulled_m(0) < 0.0028 && held.time_s() < begin_s + 20.0) {
      until([&] {
        held.frame([] { set_force({1, 0, 0}); });
        return true;
      });
      std::this_thread::sleep_for(std::chrono::milliseconds(16));
    }
    CHECK(held.pulled_m(0) >= 0.0028);
    hdUnschedule(reader);
  }
  while (const auto error = hdGetError().errorCode)
    CHECK(error == HD_FORCE_ERROR);  // on a busy computer the frames may be late

  // Stopping the scheduler or disabling the capability switches the force off. A later start of the scheduler or of the
  // capability does not restore the force.
  const bool by_scheduler = frames % 2 == 0;
  if (by_scheduler) {
    hdStopScheduler();
    hdStartScheduler();
  } else {
    hdDisable(HD_FORCE_OUTPUT);
    hdEnable(HD_FORCE_OUTPUT);
  }
  int ticks_at_rest = 0;
  CHECK(until([&] {
    held.frame([] {});
    ticks_at_rest = std::abs(held.pulled_m(0)) < 0.0015 ? ticks_at_rest + 1 : 0;
    return ticks_at_rest == 300;
  }));
}

TEST_CASE("a force that was set once ends when no poses arrive, and does not return with the poses") {
  Held held;
  hdEnable(HD_FORCE_OUTPUT);
  int frames = 0;
  CHECK(held.pulls(0, 0.0028, 0.0038, [&] {
    if (++frames == 1) set_force({1, 0, 0});
  }));
  held.control.pause();
  bool is_lost = false;
  double position_mm[3]{};
  CHECK(until([&] {
    held.frame([&] { hdGetDoublev(HD_CURRENT_POSITION, position_mm); });
    while (const auto error = hdGetError().errorCode) is_lost = is_lost || error == HD_COMM_ERROR;
    return is_lost;
  }));
  CHECK(std::abs(position_mm[0] - 1e3 * (held.rest_m[0] + held.pulled_m(0))) < 1.0);  // the last known position
  held.control.resume();
  CHECK(until([&] {
    held.frame([] {});
    return hdGetError().errorCode == HD_SUCCESS;
  }));
  int ticks_at_rest = 0;
  CHECK(until([&] {
    held.frame([] {});
    ticks_at_rest = std::abs(held.pulled_m(0)) < 0.0015 ? ticks_at_rest + 1 : 0;
    return ticks_at_rest == 300;
  }));
  CHECK(held.pulls(0, 0.0028, 0.0038, [] { set_force({1, 0, 0}); }));
}

TEST_CASE("the stop of another program is reported once, and the force stays off until the program enables it again") {
  Held held;
  hdEnable(HD_FORCE_OUTPUT);
  const auto push = [] { set_force({1, 0, 0}); };
  CHECK(held.pulls(0, 0.0028, 0.0038, push));
  forget_errors();
  const auto other = device::Device::open(*held.board.find());
  other->send(protocol::Command::stop);
  int reported_errors = 0, ticks = 0;
  CHECK(until([&] {
    held.frame(push);
    while (const auto error = hdGetError().errorCode) reported_errors += error == HD_FORCE_ERROR ? 1 : 100;
    return reported_errors > 0 && ++ticks == 1000;
  }));
  CHECK(reported_errors == 1);
  CHECK(says(HD_FORCE_ERROR, "Another program switched the force off"));
  CHECK(std::abs(held.pulled_m(0)) < 0.0015);
  hdEnable(HD_FORCE_OUTPUT);
  CHECK(held.pulls(0, 0.0028, 0.0038, push));
}

TEST_CASE("a program runs frames as fast as possible while another thread calls HDAPI") {
  Held held;
  hdEnable(HD_FORCE_OUTPUT);
  std::atomic<bool> ends = false;
  std::jthread asks([&] {
    double position_mm[3];
    while (!ends) {
      hdGetDoublev(HD_CURRENT_POSITION, position_mm);
      CHECK(hdCheckCalibration() == HD_CALIBRATION_OK);
    }
  });
  const double begin_s = held.time_s();
  while (held.pulled_m(0) < 0.0028 && held.time_s() < begin_s + 5.0)
    for (int i = 0; i < 10; ++i) held.frame([] { set_force({1, 0, 0}); });
  ends = true;
  CHECK(held.pulled_m(0) > 0.0028);
  while (const auto error = hdGetError().errorCode)
    CHECK(error == HD_FORCE_ERROR);  // on a busy computer the frames may be late
}

TEST_CASE("a board that is lost in the middle of a frame") {
  Held held;
  hdEnable(HD_FORCE_OUTPUT);
  hdBeginFrame(held.device);
  held.control.quit();
  while (hdCheckCalibration() == HD_CALIBRATION_OK) std::this_thread::yield();
  forget_errors();
  set_force({1, 0, 0});
  hdEndFrame(held.device);
  CHECK(only_error() == HD_SUCCESS);  // the next frame reports the error
  held.frame([] {});
  CHECK(only_error() == HD_COMM_ERROR);
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

TEST_CASE("a force that the board cannot confirm to be off is an error of communication") {
  Held held;
  hdEnable(HD_FORCE_OUTPUT);
  CHECK(held.pulls(0, 0.0028, 0.0038, [] { set_force({1, 0, 0}); }));
  const auto check = [&] {
    SUBCASE("hdDisable") { hdDisable(HD_FORCE_OUTPUT); }
    SUBCASE("hdStopScheduler") { hdStopScheduler(); }
  };
  SUBCASE("confirmed") {
    check();
    CHECK(only_error() == HD_SUCCESS);
  }
  SUBCASE("the cable is unplugged") {
    held.control.usb(false);
    while (hdCheckCalibration() == HD_CALIBRATION_OK) std::this_thread::yield();
    forget_errors();
    check();
    CHECK(only_error() == HD_COMM_ERROR);
  }
}

TEST_CASE("a lost connection returns automatically, and the force stays off until the program enables it again") {
  Held held;
  hdEnable(HD_FORCE_OUTPUT);
  const auto push = [] { set_force({1, 0, 0}); };
  CHECK(held.pulls(0, 0.0028, 0.0038, push));
  held.control.usb(false);
  CHECK(until([&] {
    held.frame(push);
    return hdGetError().errorCode == HD_COMM_ERROR;
  }));
  held.control.usb(true);
  int good_frames = 0;
  CHECK(until(
      [&] {
        forget_errors();
        hdBeginFrame(held.device);
        good_frames = hdGetError().errorCode == HD_SUCCESS ? good_frames + 1 : 0;
        set_force({1, 0, 0});
        hdEndFrame(held.device);
        return good_frames == 500;
      },
      100'000));
  CHECK(std::abs(held.pulled_m(0)) < 0.0015);
  hdEnable(HD_FORCE_OUTPUT);
  CHECK(held.pulls(0, 0.0028, 0.0038, [] {
    set_force({1, 0, 0});
    // A busy machine may interrupt the link or switch the force off, so the test enables the force again.
    if (hdGetError().errorCode != HD_SUCCESS) hdEnable(HD_FORCE_OUTPUT);
  }));
}

TEST_CASE("a program is not affected by the end of the previous program, and gets its force") {
  Held held;
  hdEnable(HD_FORCE_OUTPUT);
  CHECK(held.pulls(0, 0.0028, 0.0038, [] { set_force({1, 0, 0}); }));
  held.control.usb(false);
  hdStopScheduler();
  hdDisableDevice(held.device);
  held.control.usb(true);
  held.wait_for_device();
  forget_errors();
  REQUIRE(hdInitDevice(nullptr) == held.device);
  CHECK(only_error() == HD_SUCCESS);
  hdEnable(HD_FORCE_OUTPUT);
  hdStartScheduler();
  CHECK(held.pulls(0, 0.0028, 0.0038, [] {
    set_force({1, 0, 0});
    CHECK(hdGetError().errorCode == HD_SUCCESS);
  }));
}

}  // namespace
}  // namespace inkwell::tests
