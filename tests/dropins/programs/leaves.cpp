// Leaves main() while its callback is listed, or ends in the callback itself. The callback uses an object that lives as
// long as the program, and whose part that it needs is gone while the rest still goes.
#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
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
