// Forks while the scheduler of HDAPI or libhdPhantom runs: many times in the main thread and once in the callback. A
// child uses its parent's device, closes it, and exits with all destructors. Prints each unexpected result, and finally
// the state of the parent's arm.
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>

#include "tests/dropins/hdapi.hpp"

extern "C" {
int hdPhantomGetNumDevices(void);
int hdPhantomOpen(int);
int hdPhantomClose(int);
int hdPhantomGetPosition(int, double*, double*, double*);
int hdPhantomGetButtons(int);
int hdPhantomSetForce(int, const double*, const double*, const double*);
void hdPhantomStopServo(void);
}

namespace {

HHD device = HD_INVALID_HANDLE;
std::string expected;
std::atomic<int> ticks = 0;
std::atomic<bool> forks_in_callback = false;
std::atomic<pid_t> child_of_callback = 0;

void check(bool is_so, const char* what) {
  if (!is_so) std::printf("%s\n", what);
}

void check_bad_handle(const char* what) {
  const HDErrorInfo error = hdGetError();
  if (error.errorCode == HD_BAD_HANDLE && expected == hdGetErrorString(error.errorCode)) return;
  std::printf("%s: %#x %s\n", what, error.errorCode, hdGetErrorString(error.errorCode));
}

HDCallbackCode tick(void*) {
  hdBeginFrame(device);
  hdEndFrame(device);
  ++ticks;
  if (forks_in_callback.exchange(false)) {
    const pid_t child = fork();
    if (child == 0)
      alarm(120);
    else
      child_of_callback = child;
  }
  return HD_CALLBACK_CONTINUE;
}

void use_hdapi_in_child() {
  while (hdGetError().errorCode != HD_SUCCESS) continue;
  double position_mm[3];
  hdBeginFrame(device);
  check_bad_handle("hdBeginFrame");
  hdGetDoublev(HD_CURRENT_POSITION, position_mm);
  check_bad_handle("hdGetDoublev");
  hdScheduleSynchronous([](void*) { return HD_CALLBACK_DONE; }, nullptr, 1);
  hdStopScheduler();
  hdDisableDevice(device);
  check_bad_handle("hdDisableDevice");
  check(hdInitDevice(nullptr) == HD_INVALID_HANDLE, "a child has taken the arm");
}

void use_phantom_in_child() {
  double x = NAN, y = NAN, z = NAN;
  check(hdPhantomGetPosition(0, &x, &y, &z) == -1 && x == 0.0, "hdPhantomGetPosition");
  check(hdPhantomSetForce(0, &x, &y, &z) == -1, "hdPhantomSetForce");
  check(hdPhantomGetButtons(0) == -1, "hdPhantomGetButtons");
  hdPhantomStopServo();
  check(hdPhantomClose(0) == -1, "hdPhantomClose");
  check(hdPhantomOpen(0) == -1, "a child has taken the arm");
}

/// Returns the exit code, or 99 if a signal ended the child.
int wait_for(pid_t child) {
  int status = 0;
  waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : 99;
}

}  // namespace

int main(int count, char** arguments) {
  const bool is_hdapi = count > 1 && std::strcmp(arguments[1], "hdapi") == 0;
  expected = "HD_BAD_HANDLE: The device was opened by process " + std::to_string(getpid()) +
             ". Open it again in this process.";
  if (is_hdapi) {
    device = hdInitDevice(nullptr);
    if (device == HD_INVALID_HANDLE) return 1;
    hdScheduleAsynchronous(tick, nullptr, HD_DEFAULT_SCHEDULER_PRIORITY);
    hdStartScheduler();
    while (ticks < 10) usleep(1000);
  } else if (hdPhantomGetNumDevices() < 1 || hdPhantomOpen(0) != 0) {
    return 1;
  }
  for (int round = 0; round < 40; ++round) {
    std::fflush(stdout);
    const pid_t child = fork();
    if (child == 0) {
      alarm(120);
      if (round % 2 == 0) is_hdapi ? use_hdapi_in_child() : use_phantom_in_child();
      std::exit(0);  // in odd rounds the destructors find the device unchanged
    }
    if (const int code = wait_for(child); code != 0) std::printf("the child of round %d ends with %d\n", round, code);
  }
  bool goes_on = false;
  if (is_hdapi) {
    forks_in_callback = true;
    while (child_of_callback == 0) usleep(1000);
    if (const int code = wait_for(child_of_callback); code != 0)
      std::printf("the callback's child ends with %d\n", code);
    const int before = ticks;
    while (ticks < before + 100) usleep(1000);
    goes_on = true;
    while (const HDerror error = hdGetError().errorCode) goes_on = goes_on && error == HD_FORCE_ERROR;
    hdStopScheduler();
    hdDisableDevice(device);
  } else {
    double x = NAN, y = NAN, z = NAN;
    const double none_N = 0;
    goes_on = hdPhantomSetForce(0, &none_N, &none_N, &none_N) == 0 && hdPhantomGetPosition(0, &x, &y, &z) == 0;
    hdPhantomClose(0);
  }
  std::puts(goes_on ? "goes on" : "has lost its arm");
  return 0;
}
