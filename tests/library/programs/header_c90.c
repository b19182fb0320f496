/* The C header requires only C90, without warnings. */
#include <inkwell/inkwell.h>

inkwell_result read_state(inkwell_arm* arm, inkwell_arm_state* state);
inkwell_result read_state(inkwell_arm* arm, inkwell_arm_state* state) {
  return inkwell_get_state(arm, state, sizeof *state);
}
