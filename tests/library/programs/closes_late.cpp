// Closes its arm in the destructor of a global object, after the thread-local objects of the main thread were
// destroyed. The program requests all stored data before it closes the arm.
#include <cstdio>

#include <inkwell/inkwell.h>

namespace {

struct LateArm {
  inkwell_arm* arm = nullptr;

  void ask() const {
    inkwell_pose pose;
    std::printf("pose %d\n", inkwell_wait_for_pose(arm, 60.0, &pose));
    std::printf("row %s\n", inkwell_parameter_at(inkwell_parameter_count() - 1)->name);
    std::printf("fault %s\n", inkwell_fault_text(INKWELL_FAULT_OVER_SPEED));
    inkwell_get_pose(nullptr, &pose);
    std::printf("error %s\n", inkwell_error_text());
  }
  ~LateArm() {
    ask();
    std::printf("closed %d\n", inkwell_close(arm));
    std::fflush(stdout);
  }
} late;

}  // namespace

int main() {
  if (inkwell_open("virtual", &late.arm) != INKWELL_OK) {
    std::puts(inkwell_error_text());
    return 1;
  }
  late.ask();
  return 0;
}
