/*
 * Motion of a whole state: momentum, energies, temperatures.
 *
 * Velocities of vertices in a state belong to the half step ahead, energy and momentum to the step itself:
 * v(t) = v(t + dt/2) - F(t) dt / (2 M), with the forces computed anew. So measured, the energy of a leap-frog
 * fluctuates by O(dt^2) and does not drift; with half-step velocities it would fluctuate by O(dt). Solvent particles
 * fly freely since they were last streamed; under a constant acceleration a they have gained a x lag, which is added.
 * Those that exert forces on each other are half a step ahead, as vertices are.
 *
 * Sums over the solvent are made in fixed point, exactly, so that they do not depend on the order in memory: a
 * checkpoint keeps particles in id order, a running state sorts them by cell.
 */
#ifndef UNCROSS_OBSERVE_CONSERVED_H
#define UNCROSS_OBSERVE_CONSERVED_H

#include "observe/observe.h"

/* Sums over vertices. */
struct vertex_motion {
  double kinetic;    /* kT */
  double about_flow; /* the same about the mean velocity of the solvent in slabs, where it flows; without solvent in a
                        sheared box, about the linear flow */
  struct vec3 momentum; /* m a0/t0 */
};

/* Sums over solvent particles. */
struct solvent_motion {
  struct vec3 sum;          /* of v, a0/t0 */
  struct vec3 squares;      /* of v_x^2, v_y^2, v_z^2, (a0/t0)^2 */
  struct vec3 slab_squares; /* the same about the mean of each slab, one cell thick along y */
};

struct motion {
  struct solvent_motion solvent;            /* with velocities of the step */
  struct solvent_motion colliding;          /* of the time at which collisions act: with forces of pairs and drift-split
                                               half a step ahead, else the same */
  uint32_t slabs;                           /* that hold particles; 0: the solvent does not flow */
  bool linear;                              /* a sheared box without solvent */
  struct vertex_motion vertex, vertex_half; /* with velocities of the step, and of the half step ahead */
  struct vertex_motion bead;                /* of a bead; 0 without one */
  double bond, bend, pairs;                 /* kT; pairs: of the medium */
};

/* Measures a state; force: scratch, [vertices]. Numbers are NaN if a solvent velocity is not a number, or beyond 2^17
 * a0/t0. */
struct motion motion_measure(const struct model *model, const struct state *state, struct vec3 *force);

/* Temperatures relative to the velocity of the centre of mass of everything, in kT. Where total momentum is fixed, a
 * particle of mass m has m <(v - v_cm)^2> = 3 kT (1 - m/M_total), not 3 kT: each sum is divided accordingly, so that
 * the mean is 1 at any system size. Where walls, shear or a force with a profile make the solvent flow, temperatures
 * are relative to the mean velocity of its slabs, one cell thick along y; in a sheared box without solvent to the
 * linear flow. In a bath of phantoms they are relative to the flow, and nothing is fixed. NaN where there is nothing to
 * measure. */
struct temperatures {
  struct vec3 solvent;        /* by component */
  double vertex, vertex_half; /* mass-weighted over all vertices, with velocities of the step, and of the half step */
};
struct temperatures motion_temperatures(const struct model *model, const struct motion *motion);

#endif
