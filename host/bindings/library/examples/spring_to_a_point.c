/* A spring between the stylus and a point in the middle of the box.
 *
 *   Usage: spring_to_a_point [ADDRESS]     address of the arm for inkwell_open() */
#include <stdio.h>

#include <inkwell/inkwell.h>

static const double point_m[3] = {0.0, 0.0, -0.03};
static const double stiffness_N_per_m = 100.0;

static int spring(inkwell_arm* arm, const inkwell_pose* pose, double force_N[3], void* user) {
  (void)arm, (void)user;
  for (int i = 0; i < 3; ++i) force_N[i] = stiffness_N_per_m * (point_m[i] - pose->position_m[i]);
  return 0;
}

int main(int argc, char** argv) {
  inkwell_arm* arm = NULL;
  if (inkwell_open(argc > 1 ? argv[1] : NULL, &arm) != INKWELL_OK || inkwell_enable_force(arm, 5.0) != INKWELL_OK ||
      inkwell_start_servo(arm, spring, NULL) != INKWELL_OK) {
    fprintf(stderr, "%s\n", inkwell_error_text());
    inkwell_close(arm);
    return 1;
  }
  puts("Press Enter to end.");
  getchar();
  inkwell_close(arm);
  return 0;
}
