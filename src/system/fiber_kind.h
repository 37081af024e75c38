/* Lengths and frequencies of one kind of fiber. The bounds of a model, starts and theory use them.
 * Units a0 = kT = m = 1. */
#ifndef UNCROSS_SYSTEM_FIBER_KIND_H
#define UNCROSS_SYSTEM_FIBER_KIND_H

#include "system/model.h"

/* Number of bonds of one fiber: N_v - 1, for a ring N_v. */
double fiber_bonds(const struct fiber_kind *kind);

/* Whether vertex i of each fiber, from 0, is held: contact/held.h. */
static inline bool fiber_holds(const struct fiber_kind *kind, uint32_t i)
{
  return kind->frozen || (kind->held != HELD_NONE && i == 0) || (kind->held == HELD_ENDS && i + 1 == kind->vertices);
}

/* How many vertices of each fiber are held. */
static inline uint32_t fiber_held(const struct fiber_kind *kind)
{
  if (kind->frozen)
    return kind->vertices;
  return fiber_holds(kind, 0) + (kind->vertices > 1 && fiber_holds(kind, kind->vertices - 1));
}

/* Whether all are: the fiber stands. */
static inline bool fiber_stands(const struct fiber_kind *kind)
{
  return fiber_held(kind) == kind->vertices;
}

/* A Gaussian chain that stands for a finer one keeps one of its sizes. The square of the other, or the same, over that
 * of the finer chain; 1 without a finer one. */
double fiber_coarse_ratio(const struct fiber_kind *kind, enum fiber_size size);

/* k of the finer chain over k of this one: <l^2> over that of the finer one is its inverse. */
double fiber_coarse_softening(const struct fiber_kind *kind);

/* Mean bond length of a bond of this kind in equilibrium, in a0. */
double fiber_mean_bond(const struct fiber_kind *kind);

/* Contour length: bonds times mean bond length, a0. The paper's L is theory_length. */
double fiber_contour(const struct fiber_kind *kind);

/* Highest frequency of stretching in a straight chain, 1/t0: 2 sqrt(k/M) cos(pi/2N_v), 2 sqrt(k/M) in a ring. */
double fiber_stretch_frequency(const struct fiber_kind *kind);

/* Highest frequency of bending of a straight chain at its mean bond length b, 1/t0: sqrt(kappa lambda/(M b^2)), lambda
 * the largest eigenvalue of the fourth-difference matrix of a free chain (16 for N_v -> infinity and for rings). */
double fiber_bend_frequency(const struct fiber_kind *kind);

/* Highest frequency of a straight chain at its mean bond length, 1/t0: the larger of stretching along the chain and of
 * motion across it, where bends and the tension of the bonds, k(1 - l0/b) per length, act together (the sum of their
 * two maxima, a close upper bound). A leap-frog of step dt is unstable above 2/dt. */
double fiber_highest_frequency(const struct fiber_kind *kind);

/* Checks all kinds of a model whose box and crossing are known, and derives their masses, bends, springs and tubes.
 * False, with the reason in *error. */
bool fibers_finish(struct model *model, struct model_error *error);

#endif
