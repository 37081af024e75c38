/*
 * AT+a of LANES members, and of LANES cells, at once (spin.h, spin.c, at_plus_a.c). Sums are in halves: their integers
 * are those of the plain sums, and what follows from these has the same operations in the same order.
 */
#ifndef UNCROSS_MPC_RULES_SPIN_LANES_H
#define UNCROSS_MPC_RULES_SPIN_LANES_H

#include <stddef.h>

#include "mpc/cell_lanes.h"
#include "mpc/rules/spin.h"

_Static_assert(sizeof(struct spin_halves) == 24 * sizeof(double) && sizeof(struct cell_spin) == 24 * sizeof(double) &&
                   offsetof(struct spin_halves, near_angular) == 12 * sizeof(double) &&
                   offsetof(struct spin_halves, near_second) == 15 * sizeof(double),
               "three records of eight: angular, first, second, near_angular, near_second");

/* --- members ------------------------------------------------------------------------------------------------------ */

/* Where members are in memory: copies of pointers, which nothing that is written can change. */
struct spin_columns {
  const int64_t *x[3];
  double *v[3];
  const double *drawn[3];
  int64_t shift[3];
  const uint32_t *cell;
};

INLINE struct spin_columns spin_columns_of(const struct solvent *s, const struct mpc *c)
{
  return (struct spin_columns){.x = {s->x, s->y, s->z},
                               .v = {s->vx, s->vy, s->vz},
                               .drawn = {c->drawn[0], c->drawn[1], c->drawn[2]},
                               .shift = {c->shift.x, c->shift.y, c->shift.z},
                               .cell = c->solvent_cell};
}

/* Coordinates in their cells, from 0 on: spin_place is relative to the middle. */
INLINE words spin_within_lanes(const int64_t *x, int64_t shift)
{
  return (load_words(x) + (uint64_t)shift) & ((uint64_t)LATTICE_CELL - 1);
}

/* spin_add_halves: what the members from place i on add, record by record of four. */
INLINE void spin_records_lanes(const struct spin_columns *s, uint32_t i, double record[5][4 * LANES],
                               double last[LANES])
{
  words y[3], p[3];
  reals near[3], u[3];
  UNROLL
  for (int a = 0; a < 3; a++) {
    const words within = spin_within_lanes(&s->x[a][i], s->shift[a]);
    y[a] = within - (uint64_t)LATTICE_CELL / 2;
    near[a] = reals_from_small_less(within, 0.5 * (double)LATTICE_CELL);
    u[a] = load_reals(&s->v[a][i]) - load_reals(&s->drawn[a][i]);
    p[a] = round_to_words(CELL_MOMENTUM_SCALE * u[a]);
  }
  reals angular[4] = {(reals)(y[1] * p[2] - y[2] * p[1]), (reals)(y[2] * p[0] - y[0] * p[2]),
                      (reals)(y[0] * p[1] - y[1] * p[0]), (reals)y[0]};
  store_records(record[0], angular);
  reals first[4] = {(reals)y[1], (reals)y[2], (reals)(y[0] * y[0]), (reals)(y[1] * y[1])};
  store_records(record[1], first);
  reals second[4] = {(reals)(y[2] * y[2]), (reals)(y[1] * y[2]), (reals)(y[2] * y[0]), (reals)(y[0] * y[1])};
  store_records(record[2], second);
  reals near_angular[4] = {near[1] * u[2] - near[2] * u[1], near[2] * u[0] - near[0] * u[2],
                           near[0] * u[1] - near[1] * u[0], near[0] * near[0]};
  store_records(record[3], near_angular);
  reals near_second[4] = {near[1] * near[1], near[2] * near[2], near[1] * near[2], near[2] * near[0]};
  store_records(record[4], near_second);
  store_reals(last, near[0] * near[1]);
}

/* Adds the members from place `first` on, n of them, a multiple of LANES, to the halves of their cells. */
INLINE void spin_add_lanes(const struct solvent *solvent, const struct mpc *c, uint32_t first, uint32_t n)
{
  const struct spin_columns s = spin_columns_of(solvent, c);
  struct cell_spin *const spin = c->spin;
  enum { AHEAD = 16 }; /* members: the three cache lines of a cell are asked for ahead */
  for (uint32_t i = first; i < first + n; i += LANES) {
    double record[5][4 * LANES], last[LANES];
    for (uint32_t k = i + AHEAD; k < i + AHEAD + LANES && k < first + n; k++)
      for (size_t line = 0; line < sizeof(struct cell_spin); line += 64)
        __builtin_prefetch((const char *)&spin[s.cell[k]] + line, 1);
    spin_records_lanes(&s, i, record, last);
    UNROLL
    for (uint32_t slot = 0; slot < LANES; slot++) {
      struct spin_halves *h = &spin[s.cell[i + slot_lane[slot]]].halves;
      UNROLL
      for (size_t k = 0; k < 3; k++)
        add_record((uint64_t *)h + 4 * k, &record[k][(size_t)4 * slot]);
      UNROLL
      for (size_t k = 3; k < 5; k++)
        add_real_record((double *)h + 4 * k, &record[k][(size_t)4 * slot]);
      h->near_second[5] += last[slot_lane[slot]];
    }
  }
}

/* New velocities of the members from place i on. */
INLINE void spin_turn_lanes(const struct spin_columns *s, const struct cell_turn *turns, const struct point *middles,
                            uint32_t i)
{
  const double *middle[LANES];
  reals turn[8], at[4], r[3];
  load_columns((const double *)turns, &s->cell[i], turn, 8);
  UNROLL
  for (int k = 0; k < LANES; k++)
    middle[k] = (const double *)&middles[s->cell[i + (uint32_t)k]];
  load_columns_at(middle, at, 4); /* the fourth one is of the next cell */
  UNROLL
  for (int a = 0; a < 3; a++) {
    const words away = spin_within_lanes(&s->x[a][i], s->shift[a]) - (uint64_t)LATTICE_CELL / 2 - (words)at[a];
    const reals magic = (reals){0} + LATTICE_ROUND_MAGIC;
    r[a] = ((reals)((words)magic + away) - magic) * LATTICE_UNIT; /* spin_difference */
  }
  UNROLL
  for (int a = 0; a < 3; a++) {
    const int b = (a + 1) % 3, d = (a + 2) % 3;
    const reals drawn = load_reals(&s->drawn[a][i]), turned = turn[a] + (turn[4 + b] * r[d] - turn[4 + d] * r[b]);
    store_reals(&s->v[a][i], choose(turn[3] != 0.0, turned + drawn, load_reals(&s->v[a][i])));
  }
}

/* --- cells -------------------------------------------------------------------------------------------------------- */

struct vec3_lanes {
  reals x[3];
};

INLINE struct vec3_lanes cross_lanes(struct vec3_lanes a, struct vec3_lanes b)
{
  return (struct vec3_lanes){
      {a.x[1] * b.x[2] - a.x[2] * b.x[1], a.x[2] * b.x[0] - a.x[0] * b.x[2], a.x[0] * b.x[1] - a.x[1] * b.x[0]}};
}

/* The upper half of the integer whose lower half is this, and that is less than 2^63 from near 2^64. */
INLINE words spin_high_lanes(words low, reals near)
{
  const reals fraction = (reals)(low >> 12 | 0x3ff0000000000000) - 1.0;
  return round_to_words(near - fraction);
}

/* size_in_double of an integer times 2^bits, bits 0 or 16; high < 2^52 after the shift. */
INLINE reals spin_size_lanes(words high, words low, const int bits)
{
  const words top = bits ? high << 16 | low >> 48 : high, middle = low >> (32 - bits) & 0xffffffff,
              bottom = low << bits & 0xffffffff;
  return reals_from_small(top) * 0x1p64 + reals_from_small(middle) * 0x1p32 + reals_from_small(bottom);
}

/* in_double of the same. */
INLINE reals spin_double_lanes(words high, words low, const int bits)
{
  const words sign = negative(high), carry = (words)(low == 0) & sign;
  const reals size = spin_size_lanes((high ^ sign) - carry, (low ^ sign) - sign, bits);
  return (reals)((words)size | (sign & 0x8000000000000000));
}

/* rate_of_line. */
INLINE struct vec3_lanes spin_line_lanes(const reals c[6], reals trace, const struct vec3_lanes *l)
{
  const wholes second = c[1] > c[0], third = c[2] > choose(second, c[1], c[0]);
  const reals x = choose(third, c[4], choose(second, c[5], c[0])), y = choose(third, c[3], choose(second, c[1], c[5])),
              z = choose(third, c[2], choose(second, c[3], c[4]));
  const reals scale = 1.0 / square_root(x * x + y * y + z * z), ex = scale * x, ey = scale * y, ez = scale * z;
  const reals along = -(ex * l->x[0] + ey * l->x[1] + ez * l->x[2]), inverse = 1.0 / trace;
  return (struct vec3_lanes){
      {inverse * (l->x[0] + along * ex), inverse * (l->x[1] + along * ey), inverse * (l->x[2] + along * ez)}};
}

/* spin_rate. */
INLINE struct vec3_lanes spin_rate_lanes(const reals c[6], const struct vec3_lanes *l)
{
  const reals trace = c[0] + c[1] + c[2];
  const reals xx = c[1] + c[2], yy = c[2] + c[0], zz = c[0] + c[1], yz = -c[3], zx = -c[4], xy = -c[5];
  const reals minor_x = yy * zz - yz * yz, minor_y = zz * xx - zx * zx, minor_z = xx * yy - xy * xy;
  const reals determinant = xx * minor_x + xy * (yz * zx - xy * zz) + zx * (xy * yz - yy * zx);
  const wholes spread = trace > 0.0,
               line = ~(determinant > SPIN_LEAST_SHARE * 2.0 * trace * (minor_x + minor_y + minor_z));
  const reals t21 = xy / xx, t31 = zx / xx, d2 = yy - t21 * xy, below = yz - t21 * zx, t32 = below / d2;
  const reals d3 = zz - t31 * zx - t32 * below;
  const reals b2 = l->x[1] - t21 * l->x[0], b3 = l->x[2] - t31 * l->x[0] - t32 * b2;
  struct vec3_lanes w;
  w.x[2] = b3 / d3;
  w.x[1] = b2 / d2 - t32 * w.x[2];
  w.x[0] = l->x[0] / xx - t21 * w.x[1] - t31 * w.x[2];
  if (!none((words)(line & spread))) {
    const struct vec3_lanes flat = spin_line_lanes(c, trace, l);
    UNROLL
    for (int k = 0; k < 3; k++)
      w.x[k] = choose(line, flat.x[k], w.x[k]);
  }
  UNROLL
  for (int k = 0; k < 3; k++)
    w.x[k] = choose(spread, w.x[k], (reals){0});
  return w;
}

/* Sums of LANES cells about the lattice points next to their centres of mass: spin_moments. */
struct spin_lanes {
  words middle[3];
  struct vec3_lanes beyond, angular;
  reals second[6];
};

/* members: of empty cells 0, whose numbers are not used afterwards; p: momenta as they are summed. */
INLINE void spin_moments_lanes(const struct mpc *c, const uint32_t cell[LANES], reals members, const words p[3],
                               const struct vec3_lanes *center, struct spin_lanes *m)
{
  static const int row[6] = {0, 1, 2, 1, 2, 0}, column[6] = {0, 1, 2, 2, 0, 1};
  reals sum[24], x[3], rest[3], whole[3], momentum[3];
  words first[3], wrest[3];
  UNROLL
  for (uint32_t third = 0; third < 3; third++) {
    uint32_t number[LANES];
    UNROLL
    for (int k = 0; k < LANES; k++)
      number[k] = 3 * cell[k] + third;
    load_columns((const double *)c->spin, number, &sum[8 * third], 8);
  }
  const reals inverse = 1.0 / members;
  UNROLL
  for (int k = 0; k < 3; k++) {
    first[k] = (words)sum[3 + k];
    whole[k] = reals_from_signed(first[k]);
    m->middle[k] = round_to_words(whole[k] / members);
    x[k] = reals_from_signed(m->middle[k]);
    rest[k] = whole[k] - members * x[k]; /* integers below 2^53 */
    wrest[k] = round_to_words(rest[k]);
    momentum[k] = reals_from_signed(p[k]);
    m->beyond.x[k] = LATTICE_UNIT * inverse * rest[k];
  }
  UNROLL
  for (int k = 0; k < 6; k++) { /* members x x = (first - rest) x */
    const int a = row[k], b = column[k];
    const words low = (words)sum[6 + k] - m->middle[a] * wrest[b] - m->middle[b] * first[a];
    const reals near = sum[15 + k] - x[a] * rest[b] - x[b] * whole[a];
    const words high = spin_high_lanes(low, near * 0x1p-64);
    const reals spread = k < 3 ? spin_size_lanes(high, low, 16) : spin_double_lanes(high, low, 16);
    m->second[k] = 0x1p-96 * (spread - inverse * rest[a] * (0x1p16 * rest[b]));
  }
  struct vec3_lanes l, total;
  UNROLL
  for (int k = 0; k < 3; k++) {
    const int a = (k + 1) % 3, b = (k + 2) % 3;
    const words low = (words)sum[k] - m->middle[a] * p[b] + m->middle[b] * p[a];
    const reals near = sum[12 + k] * CELL_MOMENTUM_SCALE - x[a] * momentum[b] + x[b] * momentum[a];
    l.x[k] = 0x1p-84 * spin_double_lanes(spin_high_lanes(low, near * 0x1p-64), low, 0);
    total.x[k] = members * center->x[k];
  }
  const struct vec3_lanes moved = cross_lanes(m->beyond, total);
  UNROLL
  for (int k = 0; k < 3; k++)
    m->angular.x[k] = l.x[k] - moved.x[k];
}

/* spin_solve of the cells first .. first + LANES - 1; sums and halves are set to 0 where the callers say so. Loads and
 * members are counted (struct solved). */
INLINE void spin_solve_lanes(struct mpc *c, uint32_t first, const bool clears, words counts[2])
{
  reals p[4], turn[8] = {{0}};
  uint32_t cell[LANES];
  load_records(&c->sum[first], p);
  const words load = (words)p[3], others = cell_others_lanes(load), two = cell_collides_lanes(others);
  const words momentum[3] = {(words)p[0], (words)p[1], (words)p[2]};
  counts[0] |= load;
  counts[1] += others & two;
  if (clears)
    memset(&c->sum[first], 0, LANES * sizeof *c->sum);
  UNROLL
  for (uint32_t k = 0; k < LANES; k++)
    cell[k] = first + lane_record[k];
  const reals scale = cell_center_scale_lanes(load), members = reals_from_small(load >> 40);
  struct vec3_lanes center;
  struct spin_lanes about;
  UNROLL
  for (int k = 0; k < 3; k++)
    center.x[k] = reals_from_signed(momentum[k]) * scale;
  spin_moments_lanes(c, cell, members, momentum, &center, &about);
  memset(&c->spin[first], 0, LANES * sizeof *c->spin);
  const struct vec3_lanes axis = spin_rate_lanes(about.second, &about.angular);
  const struct vec3_lanes ahead = cross_lanes(axis, about.beyond);
  int64_t middle[3][LANES];
  UNROLL
  for (int k = 0; k < 3; k++) {
    turn[k] = (reals)((words)(center.x[k] - ahead.x[k]) & two);
    turn[4 + k] = (reals)((words)axis.x[k] & two);
    store_words(middle[k], about.middle[k]);
  }
  turn[7] = (reals){0} + 1.0;
  turn[3] = (reals)((words)turn[7] & two);
  store_columns((double *)c->turn, first, turn);
  for (int k = 0; k < LANES; k++)
    c->middle[cell[k]] = (struct point){middle[0][k], middle[1][k], middle[2][k]};
}

#endif
