// A typical HDAPI program: a spring of 100 N/m to the middle of the box. HDAPI uses millimeters.
#include <cstdio>

#include "tests/dropins/hdapi.hpp"

namespace {

constexpr double middle_mm[3]{0, 0, -30}, stiffness_N_per_mm = 0.1;

HDCallbackCode pull(void*) {
  double position_mm[3], force_N[3];
  hdBeginFrame(hdGetCurrentDevice());
  hdGetDoublev(HD_CURRENT_POSITION, position_mm);
  for (int i = 0; i < 3; ++i) force_N[i] = stiffness_N_per_mm * (middle_mm[i] - position_mm[i]);
  hdSetDoublev(HD_CURRENT_FORCE, force_N);
  hdEndFrame(hdGetCurrentDevice());
  return HD_CALLBACK_CONTINUE;
}

}  // namespace

int main() {
  const HHD device = hdInitDevice(nullptr);
  if (const HDErrorInfo error = hdGetError(); error.errorCode != HD_SUCCESS) {
    std::printf("%s\n", hdGetErrorString(error.errorCode));
    return 1;
  }
  hdEnable(HD_FORCE_OUTPUT);
  hdScheduleAsynchronous(pull, nullptr, HD_DEFAULT_SCHEDULER_PRIORITY);
  hdStartScheduler();
  std::puts("Press Enter to end.");
  std::fflush(stdout);
  std::getchar();
  hdStopScheduler();
  hdDisableDevice(device);
  return 0;
}
