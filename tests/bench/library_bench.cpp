// Measures how long a call of libinkwell and a frame of HDAPI occupy the calling thread. Each call is measured once per
// pose.
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <thread>
#include <vector>

#include <fmt/format.h>
#include <inkwell/inkwell.hpp>

#include "tests/dropins/hdapi.hpp"

namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t calls = 5000;

class Times {
 public:
  explicit Times(const char* what, double bound_us) : what_(what), bound_us_(bound_us) {}

  template <class Action>
  void measure(Action action) {
    const auto begin = Clock::now();
    action();
    taken_us_.push_back(std::chrono::duration<double, std::micro>(Clock::now() - begin).count());
  }
  bool is_done() const { return taken_us_.size() >= calls; }
  void print() {
    std::sort(taken_us_.begin(), taken_us_.end());
    fmt::print("{:<36} {:>9.2f} {:>9.2f} {:>9.2f} {:>9.0f}\n", what_, taken_us_.front(), taken_us_[calls / 2],
               taken_us_[calls * 99 / 100], bound_us_);
  }

 private:
  const char* what_;
  double bound_us_;
  std::vector<double> taken_us_;
};

/// This thread sleeps until wake() is called.
class Sleeper {
 public:
  ~Sleeper() {
    ends_ = true;
    wake();
    thread_.join();
  }
  void wake() {
    ++woken_;
    woken_.notify_one();
  }

 private:
  std::atomic<int> woken_ = 0;
  std::atomic<bool> ends_ = false;
  std::thread thread_{[this] {
    for (int seen = 0; !ends_; seen = woken_) woken_.wait(seen);
  }};
};

void bench_library() {
  Sleeper sleeper;
  inkwell::Arm arm("virtual");
  Times nothing("(nothing)", 0), pose("inkwell_get_pose", 1), wake("(waking a thread)", 0),
      force("inkwell_set_force, which wakes one", 1);
  const double force_N[3]{0.1, 0, 0};
  inkwell_pose now;
  while (!nothing.is_done()) {
    arm.wait_for_pose();
    nothing.measure([] {});
    pose.measure([&] { inkwell_get_pose(arm.get(), &now); });
    wake.measure([&] { sleeper.wake(); });
    force.measure([&] { inkwell_set_force(arm.get(), force_N); });
  }
  for (auto* times : {&nothing, &pose, &wake, &force}) times->print();
}

struct Frame {
  HHD device;
  Times times{"HDAPI: a frame with a force", 20};
};

HDCallbackCode frame(void* user) {
  auto& self = *static_cast<Frame*>(user);
  double position_mm[3];
  const double force_N[3]{0.1, 0, 0};
  self.times.measure([&] {
    hdBeginFrame(self.device);
    hdGetDoublev(HD_CURRENT_POSITION, position_mm);
    hdSetDoublev(HD_CURRENT_FORCE, force_N);
    hdEndFrame(self.device);
  });
  return self.times.is_done() ? HD_CALLBACK_DONE : HD_CALLBACK_CONTINUE;
}

bool bench_frames() {
  Frame state{hdInitDevice("virtual")};
  if (state.device == HD_INVALID_HANDLE) {
    fmt::print(stderr, "{}\n", hdGetErrorString(hdGetError().errorCode));
    return false;
  }
  hdEnable(HD_FORCE_OUTPUT);
  hdStartScheduler();
  hdScheduleSynchronous(frame, &state, HD_DEFAULT_SCHEDULER_PRIORITY);
  hdStopScheduler();
  hdDisableDevice(state.device);
  state.times.print();
  return true;
}

}  // namespace

int main() {
  fmt::print("{:<36} {:>9} {:>9} {:>9} {:>9}\n", "us of the calling thread", "minimum", "median", "99 %", "wanted");
  try {
    bench_library();
  } catch (const inkwell::Failure& failure) {
    fmt::print(stderr, "{}\n", failure.what());
    return 1;
  }
  return bench_frames() ? 0 : 1;
}
