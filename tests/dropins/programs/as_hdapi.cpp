// This program is linked to libHD.so. The program requests a force to the right in each tick until a line arrives on
// its standard input. With `ends-in-a-frame`, the program exits in the middle of a frame. The program prints `drives`
// when the force is on.
#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <thread>

#include "tests/dropins/hdapi.hpp"

namespace {

HHD device = HD_INVALID_HANDLE;
std::atomic<int> ticks = 0;
std::atomic<bool> has_printed = false;
bool ends_in_a_frame = false;

HDCallbackCode pull(void*) {
  const double force_N[3]{1, 0, 0};
  hdBeginFrame(device);
  hdSetDoublev(HD_CURRENT_FORCE, force_N);
  double sent_N[3]{};
  if (ends_in_a_frame && has_printed && ticks > 500) std::_Exit(3);
  hdEndFrame(device);
  hdGetDoublev(HD_CURRENT_FORCE, sent_N);
  if (sent_N[0] > 0.99) ++ticks;
  return HD_CALLBACK_CONTINUE;
}

}  // namespace

int main(int count, char** arguments) {
  ends_in_a_frame = count > 1 && std::strcmp(arguments[1], "ends-in-a-frame") == 0;
  device = hdInitDevice(nullptr);
  if (const HDErrorInfo error = hdGetError(); error.errorCode != HD_SUCCESS) {
    std::printf("%s\n", hdGetErrorString(error.errorCode));
    return 1;
  }
  hdEnable(HD_FORCE_OUTPUT);
  hdScheduleAsynchronous(pull, nullptr, HD_DEFAULT_SCHEDULER_PRIORITY);
  hdStartScheduler();
  while (ticks < 100) std::this_thread::yield();
  std::printf("drives\n");
  std::fflush(stdout);
  has_printed = true;
  std::getchar();
  return 0;
}
