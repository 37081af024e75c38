/*
 * Angular momentum of one collision cell: its sums, and the rotation that a change of velocity by u makes of them.
 *
 *   spin_add    adds a member to the sums
 *   spin_solve  Omega and the centre, so that a member at y changes its velocity to center + Omega x (y - middle) + xi
 *
 * The place y of a member is relative to the middle of its cell, in lattice units, |y| <= 2^39 for each component.
 * Every sum is exact: products of integers, in words of 128 bits. So sums do not depend on the order of the members,
 * and two members that nearly coincide lose no digits when the sums are moved to the centre of mass.
 *
 *   sum          of           unit                    largest
 *   angular[3]   y x p        2^-84 m a0^2/t0         2^104, with momenta that overflow_of_momenta lets pass
 *   first[3]     m y          2^-56 m a0              2^79, with masses that it lets pass (2^40 in units of 2^-16 m)
 *   second[6]    m y y        2^-96 m a0^2            2^118; the order is xx, yy, zz, yz, zx, xy
 *
 * p is the member's momentum as cell_add rounds it, so momentum and angular momentum are sums of the same numbers.
 */
#ifndef UNCROSS_MPC_RULES_SPIN_H
#define UNCROSS_MPC_RULES_SPIN_H

#include "base/lattice.h"
#include "mpc/cell.h"

__extension__ typedef __int128 spin_wide;
__extension__ typedef unsigned __int128 spin_word; /* unsigned: sums may wrap, see overflow.h */

/*
 * The same sums in halves, of members of mass 1 only: each as an integer modulo 2^64, and once more in doubles. If the
 * doubles are off by less than 2^62 units, both together give the integer. They are, for N members, N < 2^11:
 *
 *   second    Sums are N 2^78 < 2^89 at most. N products and N sums are rounded, each by at most 2^-53 of 2^89: the
 *             error is below 2^12 2^36 = 2^48.
 *   angular   N times the largest momentum is below 2^63 (overflow.h), so products and sums are below 2^103. All
 *             products are off by 2^-53 of that, and so are the differences; N sums are off by as much each:
 *             (N + 2) 2^50. u is taken for the rounded momentum, which is off by 1/2: N 2^39. The error is below
 *             2^61.1.
 *
 * So a member takes products of 64 bits and of doubles, and several members are added at once (spin_lanes.h).
 */
struct spin_halves {
  uint64_t angular[3], first[3], second[6]; /* modulo 2^64, units 2^-84, 2^-40, 2^-80 */
  double near_angular[3], near_second[6];   /* units 2^-40, 2^-80 */
  double unused[3];
};

#define SPIN_HALVES_MOST 2048 /* members, a power of two: the limit of the proof. Tests see no wrong sum beyond it */

struct cell_spin {
  union {
    struct {
      spin_word angular[3], first[3], second[6];
    };
    struct spin_halves halves; /* in the same place, where mpc->spin_in_halves says so */
  };
};

/* Where a lattice point is in its cell, relative to the middle of the cell, lattice units. */
static inline struct point spin_place(struct point p, struct point shift)
{
  const uint64_t within = (uint64_t)LATTICE_CELL - 1;
  const int64_t half = LATTICE_CELL / 2;
  return (struct point){(int64_t)(((uint64_t)p.x + (uint64_t)shift.x) & within) - half,
                        (int64_t)(((uint64_t)p.y + (uint64_t)shift.y) & within) - half,
                        (int64_t)(((uint64_t)p.z + (uint64_t)shift.z) & within) - half};
}

static inline spin_word spin_product(int64_t a, int64_t b)
{
  return (spin_word)((spin_wide)a * b);
}

/* A member's momentum as cell_add rounds it, 2^-44 m a0/t0. */
static inline struct point spin_momentum(double mass, struct vec3 u)
{
  const double scale = mass * CELL_MOMENTUM_SCALE;
  return (struct point){llrint(scale * u.x), llrint(scale * u.y), llrint(scale * u.z)};
}

/* Adds y x p. */
static inline void spin_add_momentum(struct cell_spin *s, struct point y, struct point p)
{
  s->angular[0] += spin_product(y.y, p.z) - spin_product(y.z, p.y);
  s->angular[1] += spin_product(y.z, p.x) - spin_product(y.x, p.z);
  s->angular[2] += spin_product(y.x, p.y) - spin_product(y.y, p.x);
}

/* Adds a member of any mass whose momentum changes by mass u, u in a0/t0. */
static inline void spin_add(struct cell_spin *s, struct point y, double mass, struct vec3 u)
{
  const spin_word m = (spin_word)(mass * CELL_MASS_SCALE + 0.5);
  spin_add_momentum(s, y, spin_momentum(mass, u));
  s->first[0] += m * (spin_word)y.x;
  s->first[1] += m * (spin_word)y.y;
  s->first[2] += m * (spin_word)y.z;
  s->second[0] += m * spin_product(y.x, y.x);
  s->second[1] += m * spin_product(y.y, y.y);
  s->second[2] += m * spin_product(y.z, y.z);
  s->second[3] += m * spin_product(y.y, y.z);
  s->second[4] += m * spin_product(y.z, y.x);
  s->second[5] += m * spin_product(y.x, y.y);
}

/* The same for a mass of 1, which is 2^16 mass units: 55 bits hold it times a coordinate. p: spin_momentum. */
static inline void spin_add_particle(struct cell_spin *s, struct point y, struct point p)
{
  const int64_t unit = (int64_t)CELL_MASS_SCALE;
  const struct point m = {unit * y.x, unit * y.y, unit * y.z};
  spin_add_momentum(s, y, p);
  s->first[0] += (spin_word)m.x;
  s->first[1] += (spin_word)m.y;
  s->first[2] += (spin_word)m.z;
  s->second[0] += spin_product(m.x, y.x);
  s->second[1] += spin_product(m.y, y.y);
  s->second[2] += spin_product(m.z, y.z);
  s->second[3] += spin_product(m.y, y.z);
  s->second[4] += spin_product(m.z, y.x);
  s->second[5] += spin_product(m.x, y.y);
}

/* Adds a member of mass 1 to sums in halves. u: its change of velocity, a0/t0, of which p is spin_momentum. */
static inline void spin_add_halves(struct spin_halves *s, struct point y, struct point p, struct vec3 u)
{
  const uint64_t x[3] = {(uint64_t)y.x, (uint64_t)y.y, (uint64_t)y.z};
  const uint64_t q[3] = {(uint64_t)p.x, (uint64_t)p.y, (uint64_t)p.z};
  const double near[3] = {(double)y.x, (double)y.y, (double)y.z}, v[3] = {u.x, u.y, u.z};
  for (int k = 0; k < 3; k++) {
    const int a = (k + 1) % 3, b = (k + 2) % 3;
    s->angular[k] += x[a] * q[b] - x[b] * q[a];
    s->first[k] += x[k];
    s->second[k] += x[k] * x[k];
    s->second[3 + k] += x[a] * x[b];
    s->near_angular[k] += near[a] * v[b] - near[b] * v[a];
    s->near_second[k] += near[k] * near[k];
    s->near_second[3 + k] += near[a] * near[b];
  }
}

/* Sums in halves become sums of 128 bits, in the same place. */
void spin_widen(struct cell_spin *s);

#define SPIN_LEAST_SHARE 1e-12 /* of the trace: an eigenvalue below it is taken as 0 */

/* Omega = Pi^-1 L, 1/t0, Pi = tr C - C, from C = sum m (y - X)(y - X), in the order of `second`, and the angular
 * momentum L (l) about X. Where all members are on one line (always, if there are two) Pi has no inverse; there the
 * part of Omega along the line is set to 0: it would turn nothing. That is if the least eigenvalue is below 1e-12 of
 * the trace. 0 if all members are at one place. */
struct vec3 spin_rate(const double c[6], struct vec3 l);

/* Moments of a cell's members about its centre of mass, which is at middle + beyond. */
struct spin_moments {
  struct point middle; /* the lattice point next to the centre of mass, relative to the middle of the cell */
  struct vec3 beyond;  /* a0 */
  double second[6];    /* C, m a0^2, in the order of `second` above */
  struct vec3 angular; /* L, m a0^2/t0 */
};

/* center: the mean velocity of the members, a0/t0. Of cells with two members or more. */
void spin_moments(const struct cell_sum *sum, const struct cell_spin *spin, struct vec3 center,
                  struct spin_moments *moments);

/* Sets center, axis (Omega, 1/t0) and factor of a cell's turn, and the middle: the lattice point next to the centre of
 * mass. A member that is alone keeps its velocity. */
void spin_solve(const struct cell_sum *sum, const struct cell_spin *spin, struct cell_turn *turn, struct point *middle);

/* AT+a: new velocities of the particles from place `first` of memory on, and of all vertices, from what they drew and
 * the turns of their cells. */
void spin_turn_from(struct state *state, const struct mpc *mpc, uint32_t first);

/* a - b in a0, exact below 2^51 lattice units; point_difference in a form that vectorises before AVX-512. */
static inline double spin_difference(int64_t a, int64_t b)
{
  return lattice_near(a - b) * LATTICE_UNIT;
}

/* center + Omega x (y - middle), a0/t0: the new velocity of the member at y, less the velocity drawn for it. */
static inline struct vec3 spin_velocity(const struct cell_turn *turn, struct point middle, struct point y)
{
  const struct vec3 r = {spin_difference(y.x, middle.x), spin_difference(y.y, middle.y),
                         spin_difference(y.z, middle.z)};
  return vec3_add(turn->center, vec3_cross(turn->axis, r));
}

#endif
