// Leaves main() while its callback is listed. The callback uses an object that lives as long as the program, and whose
// part that it needs is gone while the rest still goes.
#include <atomic>
#include <chrono>
#include <cstdio>
#include <thread>

#include "../hdapi.hpp"

using namespace std::chrono_literals;

// Not in a namespace without a name: the compiler would know who is called, and need no table for it.
struct Effect {
  virtual ~Effect() { std::this_thread::sleep_for(200ms); }
  virtual void act() = 0;
  std::atomic<int> calls = 0;
};
struct Counter final : Effect {
  void act() override { ++calls; }
};

namespace {

Counter counter;

HDCallbackCode act(void* effect) {
  static_cast<Effect*>(effect)->act();
  return HD_CALLBACK_CONTINUE;
}

}  // namespace

int main() {
  if (hdInitDevice(nullptr) == HD_INVALID_HANDLE) return 1;
  Effect& effect = counter;
  hdScheduleAsynchronous(act, &effect, HD_DEFAULT_SCHEDULER_PRIORITY);
  hdStartScheduler();
  while (counter.calls < 3) std::this_thread::sleep_for(1ms);
  std::puts("called");
  std::fflush(stdout);
  return 0;
}
