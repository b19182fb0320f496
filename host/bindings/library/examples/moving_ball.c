/* A ball that moves from side to side and pushes the hand, until button 1 of the stylus is pressed.
 *
 *   Usage: moving_ball [ADDRESS]     address of the arm for inkwell_open() */
#include <stdio.h>

#include <inkwell/inkwell.h>

static const double way_m = 0.02, speed_m_per_s = 0.04;

static int fail(inkwell_arm* arm) {
  fprintf(stderr, "%s\n", inkwell_error_text());
  inkwell_close(arm);
  return 1;
}

int main(int argc, char** argv) {
  inkwell_arm* arm = NULL;
  inkwell_object ball = {0};
  inkwell_pose pose;
  uint32_t number = 0;
  ball.shape = INKWELL_SHAPE_SPHERE;
  ball.size_m[0] = 0.015;
  ball.placement.position_m[2] = -0.03;
  if (inkwell_open(argc > 1 ? argv[1] : NULL, &arm) != INKWELL_OK ||
      inkwell_find_material("rubber", &ball.material) != INKWELL_OK ||
      inkwell_scene_add(arm, &ball, sizeof ball, &number) != INKWELL_OK ||
      inkwell_enable_force(arm, 5.0) != INKWELL_OK)
    return fail(arm);
  puts("Press button 1 of the stylus to end.");
  do {
    if (inkwell_sleep(arm, 0.01) != INKWELL_OK || inkwell_get_pose(arm, &pose) != INKWELL_OK) return fail(arm);
    /* One second to the right, one second to the left. The velocity moves the ball evenly between two calls. */
    const double passed_s = 0.001 * (pose.sequence % 1000);
    const int is_to_the_right = pose.sequence / 1000 % 2;
    ball.placement.velocity_m_per_s[0] = is_to_the_right ? speed_m_per_s : -speed_m_per_s;
    ball.placement.position_m[0] = (is_to_the_right ? -way_m : way_m) + ball.placement.velocity_m_per_s[0] * passed_s;
    if (inkwell_scene_move(arm, number, &ball.placement) != INKWELL_OK) return fail(arm);
  } while (!pose.button_1);
  inkwell_close(arm);
  return 0;
}
