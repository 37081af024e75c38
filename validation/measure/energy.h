/* Total energy of a suspension, written apart from observe/ so that either can tell on the other. */
#ifndef UNCROSS_ENERGY_H
#define UNCROSS_ENERGY_H

#include "fiber/force.h"
#include "step.h"

struct energy {
  double solvent, vertices, bonds, bends; /* kT: kinetic of both, potential */
};

/* Velocities of vertices are those half a step ahead, v(t + dt/2). The leap-frog conserves the energy that is made of
 * positions and on-step velocities v(t) = v(t + dt/2) - F dt/(2M) up to a bounded oscillation of second order; with
 * half-step velocities that oscillation is of first order and would hide a drift. Overwrites work's forces with those
 * of now, which is what they are anyway. NAN if a bond does not fit the box. */
static inline struct energy energy_on_step(const struct state *state, const struct model *model, struct work *work)
{
  const struct solvent *s = &state->solvent;
  struct energy e = {.solvent = 0.0};
  if (!fiber_forces(state, model, work->fiber.force, state->step, &work->fault))
    return (struct energy){NAN, NAN, NAN, NAN};
  for (uint32_t i = 0; i < s->n; i++)
    e.solvent += 0.5 * (s->vx[i] * s->vx[i] + s->vy[i] * s->vy[i] + s->vz[i] * s->vz[i]);
  for (uint32_t v = 0; v < state->vertices; v++) {
    struct vec3 on_step =
        vec3_add_scaled(state->velocity[v], -0.5 * model->time_step * model->inverse_mass[v], work->fiber.force[v]);
    e.vertices += 0.5 * model->mass[v] * vec3_dot(on_step, on_step);
  }
  struct fiber_energy f = fiber_energies(state, model);
  e.bonds = f.bond;
  e.bends = f.bend;
  return e;
}

static inline double energy_total(const struct energy *e)
{
  return e->solvent + e->vertices + e->bonds + e->bends;
}

#endif
