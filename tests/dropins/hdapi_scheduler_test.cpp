// Tests order and timing of the callbacks of libHD.so.
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <thread>
#include <vector>

#include "tests/cancelled_thread.hpp"

#include "tests/dropins/held.hpp"

namespace inkwell::tests {
namespace {

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
    CHECK(error == HD_ILLEGAL_BEGIN);  // the first callback may have been left over
}

TEST_CASE(
    "the scheduler runs tasks in order, waits for tasks, removes tasks, and accepts calls from the servo thread") {
  Held held;
  static std::vector<int> order;
  order.clear();
  const auto note = [](void* user) {
    if (order.size() < 6) order.push_back(*static_cast<int*>(user));
    return HD_CALLBACK_CONTINUE;
  };
  int low = 1, middle = 2, high = 3;
  std::array<HDSchedulerHandle, 3> tasks{};
  until([&] {  // the servo thread calls each task immediately and again in the next tick
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
  hdScheduleSynchronous(counts, &calls, 5);  // no other thread would call the callback
  CHECK(calls == 1);
  hdStartScheduler();
  CHECK(hdWaitForCompletion(waiting, HD_WAIT_INFINITE) == 1);
  CHECK(calls == 5);
  hdScheduleAsynchronous(nullptr, nullptr, 5);
  CHECK(only_error() == HD_INVALID_VALUE);
}

TEST_CASE("a thread that is cancelled while it waits for the scheduler exits, and the scheduler continues") {
  Held held;
  static std::atomic<int> calls;
  static std::atomic<bool> is_in, may_go;
  calls = 0;
  is_in = may_go = false;
  const auto goes_on = [](void* user) {
    ++calls;
    ++*static_cast<int*>(user);
    return HD_CALLBACK_CONTINUE;
  };
  const auto hangs = [](void*) {
    is_in = true;
    while (!may_go) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    return HD_CALLBACK_DONE;
  };
  for (int i = 0; i < 5; ++i) {
    CHECK(CancelledThread([&] {
            int on_the_stack = 0;
            hdScheduleSynchronous(goes_on, &on_the_stack, 1);
          }).ends_when_cancelled());
    const int after = calls;
    int ticks = 0;
    CHECK(until([&] { return ++ticks == 20; }));
    CHECK(calls == after);
  }
  int counted = 0;
  const auto task = hdScheduleAsynchronous(goes_on, &counted, 1);
  CHECK(CancelledThread([&] { hdWaitForCompletion(task, HD_WAIT_INFINITE); }).ends_when_cancelled());
  hdUnschedule(task);
  const auto hanging = hdScheduleAsynchronous(hangs, nullptr, 1);
  while (!is_in) std::this_thread::yield();
  CHECK(CancelledThread([&] { hdUnschedule(hanging); }).ends_when_cancelled());
  CHECK(CancelledThread([] { hdStopScheduler(); }).ends_when_cancelled());
  CHECK(CancelledThread([] { hdStartScheduler(); }).ends_when_cancelled());
  may_go = true;
  hdStartScheduler();
  int ticks = 0;
  CHECK(until([&] { return ++ticks == 20; }));
  // While the scheduler is stopped, hdScheduleSynchronous() calls the callback in the caller's thread.
  hdStopScheduler();
  CHECK(CancelledThread([] {
          hdScheduleSynchronous(
              [](void*) -> HDCallbackCode {
                std::this_thread::sleep_for(std::chrono::hours(1));
                return 0;
              },
              nullptr, 1);
        }).ends_when_cancelled());
  hdStartScheduler();
  CHECK(until([&] { return ++ticks == 40; }));
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

TEST_CASE("the measured rate is never nought: programs make time of it by 1 / rate, from the first tick on") {
  struct Rates {
    double lowest_Hz = 1e9;
    int ticks = 0;
  };
  const auto look = [](void* user) {
    auto& rates = *static_cast<Rates*>(user);
    double rate_Hz = 0;
    hdGetDoublev(HD_INSTANTANEOUS_UPDATE_RATE, &rate_Hz);
    rates.lowest_Hz = std::min(rates.lowest_Hz, rate_Hz);
    return ++rates.ticks < 20 ? HD_CALLBACK_CONTINUE : HD_CALLBACK_DONE;
  };
  Board board;
  forget_errors();
  const HHD device = hdInitDevice(nullptr);
  REQUIRE(device == 0);
  Rates rates;
  look(&rates);
  for (const double pause_s : {0.0, 2.5}) {  // after the second pause the tick rate is 0.4 Hz
    const double begin_s = board.time_s();
    while (board.time_s() - begin_s < pause_s) std::this_thread::sleep_for(std::chrono::milliseconds(5));
    rates.ticks = 0;
    const auto task = hdScheduleAsynchronous(look, &rates, HD_DEFAULT_SCHEDULER_PRIORITY);
    hdStartScheduler();
    CHECK(hdWaitForCompletion(task, HD_WAIT_INFINITE) == 1);
    hdStopScheduler();
  }
  CHECK(rates.lowest_Hz >= 1.0);
  hdDisableDevice(device);
  CHECK(only_error() == HD_SUCCESS);
}

}  // namespace
}  // namespace inkwell::tests
