/* A mass that the probe carries on a spring and a damper. */
#include "virtual_mass.h"

#include <math.h>

void virtual_mass_step(const virtual_mass_inputs* u, const virtual_mass_parameters* p, virtual_mass_state* x,
                       virtual_mass_outputs* y) {
  int i;
  float squared = 0.0f;
  if (!x->running) {
    for (i = 0; i < 3; i++) {
      x->position[i] = u->position[i];
      x->velocity[i] = 0.0f;
    }
    x->running = 1;
  }
  for (i = 0; i < 3; i++) {
    const float pull = p->stiffness * (u->position[i] - x->position[i]) - p->damping * x->velocity[i];
    x->velocity[i] += u->dt * pull / p->mass;
    x->position[i] += u->dt * x->velocity[i];
    y->force[i] = p->stiffness * (x->position[i] - u->position[i]);
    squared += x->velocity[i] * x->velocity[i];
  }
  y->speed = sqrtf(squared);
}
