/* A step function in C, in the form that MATLAB Coder, Simulink and Octave users write: inputs, parameters, state and
 * outputs are structs, and no memory is allocated. */
#ifndef VIRTUAL_MASS_H
#define VIRTUAL_MASS_H

typedef struct {
  float position[3]; /* m */
  float dt;          /* s */
} virtual_mass_inputs;

typedef struct {
  float mass;      /* kg */
  float stiffness; /* N/m */
  float damping;   /* Ns/m */
} virtual_mass_parameters;

typedef struct {
  int running;
  float position[3]; /* m */
  float velocity[3]; /* m/s */
} virtual_mass_state;

typedef struct {
  float force[3]; /* N */
  float speed;    /* m/s */
} virtual_mass_outputs;

void virtual_mass_step(const virtual_mass_inputs* u, const virtual_mass_parameters* p, virtual_mass_state* x,
                       virtual_mass_outputs* y);

#endif
