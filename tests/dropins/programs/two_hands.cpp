// This program is linked to libHD.so. The program opens two devices by the names of HDAPI programs and pushes the left
// hand to the right and the right hand to the left, until a line arrives on its standard input. The program prints the
// file of names and `drives` when both arms are referenced. With `wrong-name`, it prints the error of an unknown name.
#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <thread>

#include "tests/dropins/hdapi.hpp"

namespace {

struct Hand {
  const char* name;
  double force_N[3];
  HHD device = HD_INVALID_HANDLE;
};
Hand hands[]{{"Left PHANToM", {1, 0, 0}}, {"Right Device", {-1, 0, 0}}};
std::atomic<bool> are_referenced = false;

HDCallbackCode push(void*) {
  bool all = true;
  for (const Hand& hand : hands) {
    hdBeginFrame(hand.device);
    all = all && hdCheckCalibration() == HD_CALIBRATION_OK;
    hdSetDoublev(HD_CURRENT_FORCE, hand.force_N);
    hdEndFrame(hand.device);
  }
  if (all) are_referenced = true;
  return HD_CALLBACK_CONTINUE;
}

HHD open_device(const char* name) {
  const HHD device = hdInitDevice(name);
  if (const HDErrorInfo error = hdGetError(); error.errorCode != HD_SUCCESS)
    std::printf("%x %s\n", error.errorCode, hdGetErrorString(error.errorCode));
  return device;
}

}  // namespace

int main(int count, char**) {
  if (count > 1) {
    open_device("Middle");
    open_device("Left");
    open_device("left device");
    return 0;
  }
  for (Hand& hand : hands) {
    hand.device = open_device(hand.name);
    if (hand.device == HD_INVALID_HANDLE) return 1;
    hdEnable(HD_FORCE_OUTPUT);
  }
  hdScheduleAsynchronous(push, nullptr, HD_DEFAULT_SCHEDULER_PRIORITY);
  hdStartScheduler();
  while (!are_referenced) std::this_thread::yield();
  std::printf("%s\ndrives\n", std::getenv("INKWELL_ARMS"));
  std::fflush(stdout);
  std::getchar();
  return 0;
}
