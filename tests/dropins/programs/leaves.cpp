// The program returns from main() while a callback is scheduled, or exits in the callback. The callback uses a global
// object whose derived part is destroyed 200 ms before its base.
#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <thread>

#include "tests/dropins/hdapi.hpp"

using namespace std::chrono_literals;

// The external linkage of these types prevents the compiler from replacing the virtual call by a direct call.
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
bool exits_in_callback = false;

HDCallbackCode act(void* effect) {
  static_cast<Effect*>(effect)->act();
  if (exits_in_callback && counter.calls == 3) std::exit(3);
  return HD_CALLBACK_CONTINUE;
}

}  // namespace

int main(int count, char** arguments) {
  exits_in_callback = count > 1 && std::strcmp(arguments[1], "exits-in-callback") == 0;
  if (hdInitDevice(nullptr) == HD_INVALID_HANDLE) return 1;
  Effect& effect = counter;
  hdScheduleAsynchronous(act, &effect, HD_DEFAULT_SCHEDULER_PRIORITY);
  hdStartScheduler();
  while (exits_in_callback) std::this_thread::sleep_for(1s);
  while (counter.calls < 3) std::this_thread::sleep_for(1ms);
  std::puts("called");
  std::fflush(stdout);
  return 0;
}
